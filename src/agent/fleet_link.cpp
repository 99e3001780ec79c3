#include "fleetmap/agent/fleet_link.hpp"

#include <spdlog/spdlog.h>

#include <utility>

#include "fleetmap/fleet_codec/messages.hpp"
#include "fleetmap/fleet_codec/topics.hpp"

namespace fleetmap::agent {
namespace {

/// Often enough to keep a 15 Mbit/s window moving.
constexpr Duration kTickPeriod = std::chrono::milliseconds(20);

/// Digests, status messages and orders go on for ever; everything else moves items.
bool moves_items(const messages::Message& message) {
  return !std::holds_alternative<messages::Digest>(message) &&
         !std::holds_alternative<messages::Hold>(message) &&
         !std::holds_alternative<messages::AgentStatus>(message) &&
         !std::holds_alternative<messages::SubmapDigest>(message);
}

/// Messages by which a robot still fills its map.
bool moves_submaps(const messages::Message& message) {
  return std::holds_alternative<messages::SubmapRequest>(message) ||
         std::holds_alternative<messages::SubmapChunk>(message);
}

/// Requests. The recipient may be gone, so repeating them is no progress.
bool is_request(const messages::Message& message) {
  return std::holds_alternative<messages::CloudRequest>(message) ||
         std::holds_alternative<messages::ProximityMatch>(message) ||
         std::holds_alternative<messages::ItemRequest>(message) ||
         std::holds_alternative<messages::SubmapRequest>(message);
}

}  // namespace

FleetLink::FleetLink(const AgentId& self, bus::Bus& bus, exchange::Exchange& exchange,
                     std::function<void()> on_events)
    : bus_(bus), exchange_(exchange), on_events_(std::move(on_events)) {
  counters_.last_useful = counters_.last_submap = bus.now();
  for (const bus::Topic& topic : fleet_codec::inbox_topics(self)) {
    handles_.push_back(bus_.subscribe(topic, [this, topic](const Bytes& cdr) { receive(topic, cdr); }));
  }
  handles_.push_back(bus_.every(kTickPeriod, {"exchange", [this] { tick(); }}));
}

void FleetLink::tick() {
  const std::uint64_t discovery_bytes = bus_.discovery_bytes(bus::Link::kLongRange);
  if (discovery_bytes > discovery_bytes_)
    exchange_.on_discovery(discovery_bytes - discovery_bytes_, bus_.now());
  discovery_bytes_ = discovery_bytes;
  for (const messages::Outgoing& outgoing : exchange_.tick(bus_.now())) {
    if (!is_request(outgoing.message)) {
      if (moves_items(outgoing.message)) counters_.last_useful = bus_.now();
      if (moves_submaps(outgoing.message)) counters_.last_submap = bus_.now();
    }
    bus_.publish(fleet_codec::topic_of(outgoing), fleet_codec::encode(outgoing.message));
  }
  on_events_();
}

void FleetLink::receive(const bus::Topic& topic, const Bytes& cdr) {
  const Result<messages::Message> message = fleet_codec::decode_message(topic, cdr);
  if (!message) {
    ++counters_.refused_messages;
    if (++warned_[topic.name] == 1)
      spdlog::warn("{}: message refused: {}", topic.name, message.error().message);
    return;
  }
  if (moves_items(*message)) counters_.last_useful = bus_.now();
  if (moves_submaps(*message)) counters_.last_submap = bus_.now();
  exchange_.on_message(*message, fleet_codec::reach_of(topic.link), bus_.now(), bus_.sender());
  on_events_();
}

}  // namespace fleetmap::agent
