#include "monitor.hpp"

#include <algorithm>
#include <cmath>

#include "fleetmap/cloud/codec.hpp"
#include "fleetmap/exchange/reissue.hpp"

namespace fleetmap::fault_injection {
namespace {

/// B in any second, as one robot hears them: 160 of the radio's 200 kbit/s.
constexpr double kRadio = 20'000.0;
/// The longest status period of the largest fleet, and a queue before it.
constexpr Duration kMaxSilence = std::chrono::seconds(60);
/// Names that cost a forger nothing.
constexpr std::size_t kMaxStrangers = 64;

bool holds_content(const store::Store& store, const graph::Node& node) {
  const auto held = store.nodes_from({node.id.agent, 0, kEndOfSeqs});
  return std::ranges::any_of(held,
                             [&](const graph::Node* other) { return exchange::is_same_place(*other, node); });
}

bool includes(const store::Store& store, const Holdings& announced) {
  return store.node_set().includes(announced.nodes) && store.alignment_set().includes(announced.alignments) &&
         store.submap_set().includes(announced.submaps);
}

/// The part of `announced` that is in `held`.
store::SeqSet common(const store::SeqSet& announced, const store::SeqSet& held) {
  return store::SeqSet(announced.minus(store::SeqSet(announced.minus(held))));
}

std::string missing(const char* what, const store::SeqSet& announced, const store::SeqSet& held) {
  const auto ranges = announced.minus(held);
  if (ranges.empty()) return {};
  return std::string(" ") + what + " " + to_string(NodeId{ranges[0].agent, ranges[0].first});
}

}  // namespace

void Monitor::note(Invariant invariant, const AgentId& robot, Stamp now, const std::string& what) {
  if (checked_.contains(invariant) && noted_.insert({invariant, robot}).second)
    violations_.push_back({invariant, now - start_, robot.str(), what});
}

void Monitor::on_sent(const Packet& packet, const std::vector<AgentId>& hearers) {
  sent_[packet.from] = packet.at;
  ++packets_;
  const auto mix = [this](std::uint64_t value) { fingerprint_ = (fingerprint_ ^ value) * 0x100000001b3u; };
  mix(static_cast<std::uint64_t>(to_ns(packet.at)));
  mix(std::hash<AgentId>{}(packet.from));
  mix(packet.outgoing.message.index());
  mix(packet.wire_bytes);
  if (packet.outgoing.reach == messages::Reach::kLongRange) {
    note_radio(packet.from, packet);
    for (const AgentId& hearer : hearers) note_radio(hearer, packet);
  }
  note_announced(packet);
}

void Monitor::note_radio(const AgentId& at, const Packet& packet) {
  Medium& medium = media_[at];
  auto& last_second = medium.last_second;
  while (!last_second.empty() && packet.at - last_second.front().first >= std::chrono::seconds(1)) {
    medium.bytes -= last_second.front().second;
    last_second.pop_front();
  }
  last_second.emplace_back(packet.at, packet.wire_bytes);
  medium.bytes += static_cast<double>(packet.wire_bytes);
  max_bytes_per_second_ = std::max(max_bytes_per_second_, medium.bytes);
  if (medium.bytes > kRadio)
    note(Invariant::kBudget, at, packet.at, std::to_string(std::lround(medium.bytes)) + " B in a second");
}

void Monitor::note_announced(const Packet& packet) {
  Holdings& announced = announced_[packet.from];
  const auto insert = [](store::SeqSet& set, const std::vector<SeqRange>& ranges) {
    for (const SeqRange& range : ranges) set.insert(range);
  };
  if (const auto* digest = std::get_if<messages::Digest>(&packet.outgoing.message)) {
    insert(announced.nodes, digest->nodes);
    insert(announced.alignments, digest->alignments);
  } else if (const auto* submaps = std::get_if<messages::SubmapDigest>(&packet.outgoing.message)) {
    insert(announced.submaps, submaps->submaps);
  } else if (const auto* node = std::get_if<graph::Node>(&packet.outgoing.message)) {
    announced.nodes.insert(node->id.agent, node->id.seq);
  } else if (const auto* alignment = std::get_if<graph::Alignment>(&packet.outgoing.message)) {
    announced.alignments.insert(alignment->computed_by, alignment->seq);
  } else if (const auto* request = std::get_if<messages::SubmapRequest>(&packet.outgoing.message)) {
    constexpr std::uint32_t kChunk = store::Store::kChunkBytes;
    for (std::uint32_t at = request->offset; at < request->offset + request->length; at += kChunk)
      requested_[packet.from][request->node].insert(at / kChunk);
  }
}

void Monitor::on_made(const graph::Node& node) {
  const NodeId& id = node.id;
  announced_[id.agent].nodes.insert(id.agent, id.seq);
  announced_[id.agent].submaps.insert(id.agent, id.seq);
  made_[id.agent].push_back(node);
}

void Monitor::on_forged(const messages::Message& message) {
  if (const auto* node = std::get_if<graph::Node>(&message)) {
    forged_nodes_.insert(node->id.agent, node->id.seq);
  } else if (const auto* alignment = std::get_if<graph::Alignment>(&message)) {
    forged_alignments_.insert(alignment->computed_by, alignment->seq);
  }
}

void Monitor::on_started(const AgentId& robot, const store::Store& store, bool disk_intact, Stamp now) {
  sent_[robot] = now;
  if (disk_intact) return check_held(robot, store, now);
  std::erase_if(made_[robot], [&](const graph::Node& node) { return !holds_content(store, node); });
  Holdings& announced = announced_[robot];
  announced = {common(announced.nodes, store.node_set()), common(announced.alignments, store.alignment_set()),
               common(announced.submaps, store.submap_set())};
}

void Monitor::check_held(const AgentId& robot, const store::Store& store, Stamp now) {
  Holdings announced = announced_[robot];
  // A name with two contents is held, and neither content has a submap.
  announced.submaps = store::SeqSet(announced.submaps.minus(forged_nodes_));
  if (includes(store, announced)) return;
  note(Invariant::kNothingLost, robot, now,
       "told that it holds, and does not:" + missing("node", announced.nodes, store.node_set()) +
           missing("alignment", announced.alignments, store.alignment_set()) +
           missing("submap", announced.submaps, store.submap_set()));
}

void Monitor::check_contents(const AgentId& robot, const store::Store& store, Stamp now) {
  for (const auto& [maker, nodes] : made_) {
    const auto lost =
        std::ranges::find_if(nodes, [&](const graph::Node& node) { return !holds_content(store, node); });
    if (lost != nodes.end())
      note(Invariant::kNothingLost, robot, now, "lacks what was made as node " + to_string(lost->id));
  }
}

void Monitor::on_conflict(const AgentId& robot, const exchange::ItemConflict& conflict, Stamp now) {
  const store::SeqSet& forged = conflict.alignment ? forged_alignments_ : forged_nodes_;
  if (forged.contains(conflict.id.agent, conflict.id.seq)) return;
  note(Invariant::kOwnItems, robot, now,
       std::string("another ") + (conflict.alignment ? "alignment " : "node ") + to_string(conflict.id) +
           " came");
}

void Monitor::check_bounds(const AgentId& name, const ExchangeFleet::Robot& robot, Stamp now) {
  const auto bound = [&](const std::string& what, std::size_t size, std::size_t max_size) {
    if (size <= max_size) return;
    note(Invariant::kBounded, name, now,
         std::to_string(size) + ' ' + what + ", bound " + std::to_string(max_size));
  };
  const exchange::LongRangeConfig& config = config_->long_range;
  const std::size_t peers = config_->fleet.size() - 1;
  const exchange::SendQueue& queue = robot.exchange->queue();
  for (std::size_t p = 0; p < exchange::kPriorities; ++p) {
    const auto priority = static_cast<exchange::Priority>(p);
    bound("messages wait", queue.size(priority),
          priority == exchange::Priority::kBackfill ? config.max_backfill
          : priority == exchange::Priority::kCloud  ? config.max_fragments
                                                    : config.max_small);
  }
  const exchange::TableSizes tables = robot.exchange->table_sizes();
  bound("peers of items", tables.item_peers, peers);
  bound("peers of submaps", tables.submap_peers, peers);
  bound("peers that are served submaps", tables.submap_requesters, peers);
  bound("downloads", tables.submap_downloads, robot.store->nodes().size());
  bound("clouds to make", tables.clouds_to_make, robot.store->nodes().size());
  bound("strangers", tables.strangers, kMaxStrangers);
  bound("refusals told of", tables.refusals, kMaxStrangers);
}

void Monitor::check_downloads(const AgentId& name, const store::Store& store, Stamp now) {
  for (const NodeId& id : store.partial_submaps()) {
    const auto& requested = requested_[name][id];
    const auto missing = store.missing_chunks(id);
    const std::uint32_t bytes = store.node(id)->submap_bytes;
    for (std::uint32_t chunk = 0; chunk * store::Store::kChunkBytes < bytes; ++chunk) {
      if (requested.contains(chunk) || std::ranges::binary_search(missing, chunk)) continue;
      note(Invariant::kBounded, name, now, "chunk of " + to_string(id) + " on the disk was not requested");
    }
  }
}

void Monitor::on_decoded(const AgentId& robot, ByteView encoded, const cloud::PointCloud& cloud, Stamp now) {
  if (cloud.size() > cloud::max_points_in(encoded.size()))
    note(Invariant::kBounded, robot, now,
         std::to_string(cloud.size()) + " points of " + std::to_string(encoded.size()) + " B");
}

void Monitor::check(const std::map<AgentId, ExchangeFleet::Robot>& robots, Stamp now) {
  for (const auto& [name, robot] : robots) {
    if (now - sent_[name] > kMaxSilence) note(Invariant::kAlive, name, now, "nothing was sent");
    check_bounds(name, robot, now);
    check_downloads(name, *robot.store, now);
  }
}

void Monitor::fill(Outcome& outcome) const {
  outcome.violations = violations_;
  outcome.max_bytes_per_second = max_bytes_per_second_;
  outcome.packets = packets_;
  outcome.fingerprint = fingerprint_;
}

}  // namespace fleetmap::fault_injection
