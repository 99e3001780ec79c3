#include "fleetmap/exchange/send_queue.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fleetmap::exchange {
namespace {

constexpr auto kBackfill = static_cast<std::size_t>(Priority::kBackfill);
constexpr auto kCloud = static_cast<std::size_t>(Priority::kCloud);

}  // namespace

Status LongRangeConfig::validate() const {
  if (!(fleet_bytes_per_second > 0.0) || !std::isfinite(fleet_bytes_per_second)) {
    return failure("long_range.fleet_bytes_per_second must be positive");
  }
  if (!(burst_seconds >= 0.0) || burst_seconds > 10.0)
    return failure("long_range.burst_seconds must be in 0 .. 10");
  if (!(min_burst_bytes >= 0.0) || min_burst_bytes > 1e6) {
    return failure("long_range.min_burst_bytes must be in 0 .. 1e6");
  }
  if (!(small_reserve_bytes >= 0.0) || small_reserve_bytes > 1e6) {
    return failure("long_range.small_reserve_bytes must be in 0 .. 1e6");
  }
  if (max_small == 0 || max_backfill == 0 || max_fragments == 0) {
    return failure("long_range.max_small, max_backfill and max_fragments must be at least 1");
  }
  return {};
}

SendQueue::SendQueue(const LongRangeConfig& config, std::size_t fleet_size,
                     std::function<std::size_t(const Message&)> payload_size)
    : config_(config),
      copies_(config.copies(fleet_size)),
      payload_size_(std::move(payload_size)),
      share_(config.fleet_bytes_per_second / static_cast<double>(std::max<std::size_t>(fleet_size, 1))),
      bucket_(share_, std::max(config.burst_seconds * share_, config.min_burst_bytes)) {}

SendQueue::Key SendQueue::key_of(const Outgoing& outgoing) {
  struct Subject {
    NodeId node;
    std::uint32_t part = 0;
  };
  struct Visitor {
    Subject operator()(const graph::Node& m) const { return {m.id, 0}; }
    Subject operator()(const graph::Alignment& m) const { return {{m.computed_by, m.seq}, 0}; }
    Subject operator()(const ProximityMatch& m) const { return {m.theirs, m.ours.seq}; }
    Subject operator()(const CloudFragment& m) const { return {m.node, m.index}; }
    Subject operator()(const CloudRequest& m) const { return {m.node, 0}; }
    Subject operator()(const Digest&) const { return {}; }
    Subject operator()(const ItemRequest&) const { return {}; }
    Subject operator()(const AgentStatus&) const { return {}; }
    Subject operator()(const MissionReport&) const { return {}; }
    Subject operator()(const Hold&) const { return {}; }
    Subject operator()(const SubmapDigest&) const { return {}; }
    Subject operator()(const SubmapRequest& m) const { return {m.node, m.offset}; }
    Subject operator()(const SubmapChunk& m) const { return {m.node, m.offset}; }
  };
  const Subject subject = std::visit(Visitor{}, outgoing.message);
  return {outgoing.message.index(), outgoing.to.value_or(AgentId{}), subject.node, subject.part};
}

std::size_t SendQueue::wire_bytes(const Message& message, const std::optional<AgentId>& to) const {
  const std::size_t copies = to && config_.deliver_to_one ? 1 : copies_;
  return (payload_size_(message) + config_.overhead_bytes) * copies;
}

std::size_t SendQueue::capacity(std::size_t priority) const {
  if (priority == kCloud) return config_.max_fragments;
  return priority == kBackfill ? config_.max_backfill : config_.max_small;
}

void SendQueue::erase(const Place& place) {
  backlog_ -= place.item->bytes;
  index_.erase(place.item->key);
  waiting_[place.priority].erase(place.item);
}

void SendQueue::push(Priority priority, Message message, std::optional<AgentId> to) {
  if (!to) to = recipient_of(message);
  Item item{{}, {Reach::kLongRange, to, std::move(message)}, 0};
  item.key = key_of(item.outgoing);
  item.bytes = wire_bytes(item.outgoing.message, to);
  if (const auto same = index_.find(item.key); same != index_.end()) {
    backlog_ += item.bytes - same->second.item->bytes;
    *same->second.item = std::move(item);
    ++stats_.superseded;
    return;
  }
  const auto p = static_cast<std::size_t>(priority);
  if (waiting_[p].size() >= capacity(p)) {
    erase({p, waiting_[p].begin()});
    ++stats_.dropped[p];
  }
  backlog_ += item.bytes;
  waiting_[p].push_back(std::move(item));
  index_.emplace(waiting_[p].back().key, Place{p, std::prev(waiting_[p].end())});
}

std::size_t SendQueue::cancel_cloud(const AgentId& to, const NodeId& node) {
  std::vector<Place> places;
  auto& fragments = waiting_[kCloud];
  for (auto it = fragments.begin(); it != fragments.end(); ++it) {
    const auto* fragment = std::get_if<CloudFragment>(&it->outgoing.message);
    if (fragment && fragment->to == to && fragment->node == node) places.push_back({kCloud, it});
  }
  for (const Place& place : places) erase(place);
  stats_.cancelled += places.size();
  return places.size();
}

std::vector<Outgoing> SendQueue::take_for(const std::set<AgentId>& peers) {
  std::vector<Outgoing> taken;
  if (peers.empty()) return taken;
  for (std::size_t p = 0; p < kPriorities; ++p) {
    for (auto it = waiting_[p].begin(); it != waiting_[p].end();) {
      const auto item = it++;
      if (!item->outgoing.to || !peers.contains(*item->outgoing.to)) continue;
      taken.push_back(std::move(item->outgoing));
      erase({p, item});
    }
  }
  return taken;
}

std::optional<std::size_t> SendQueue::next() const {
  for (std::size_t p = 0; p < kBackfill; ++p) {
    if (!waiting_[p].empty()) return p;
  }
  if (waiting_[kBackfill].empty() && waiting_[kCloud].empty()) return std::nullopt;
  if (waiting_[kCloud].empty()) return kBackfill;
  if (waiting_[kBackfill].empty()) return kCloud;
  return cloud_lead_ > 0.0 ? kBackfill : kCloud;
}

std::vector<Outgoing> SendQueue::take(Stamp now) {
  std::vector<Outgoing> due;
  while (const auto p = next()) {
    const Items::iterator item = waiting_[*p].begin();
    const double reserve = *p >= kBackfill ? config_.small_reserve_bytes : 0.0;
    if (!bucket_.take(static_cast<double>(item->bytes), now, reserve)) break;
    const bool both_wait = !waiting_[kBackfill].empty() && !waiting_[kCloud].empty();
    if (*p >= kBackfill) {
      const auto bytes = static_cast<double>(item->bytes);
      cloud_lead_ = both_wait ? cloud_lead_ + (*p == kCloud ? bytes : -bytes) : 0.0;
    }
    ++stats_.sent[*p];
    stats_.wire_bytes += item->bytes;
    due.push_back(std::move(item->outgoing));
    erase({*p, item});
  }
  return due;
}

}  // namespace fleetmap::exchange
