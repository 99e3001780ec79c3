#include "neighbour_table.hpp"

#include <algorithm>

#include "digest_part.hpp"

namespace fleetmap::exchange {
namespace {

/// Share of the digests expected in a peer_timeout that a near robot delivers.
constexpr double kNearShare = 0.6;

}  // namespace

void NeighbourTable::on_heard(const AgentId& name, Stamp now) {
  Neighbour& neighbour = neighbours_[name];
  if (now - neighbour.heard > config_.peer_timeout) neighbour.hears_us = false;
  neighbour.heard = now;
}

void NeighbourTable::on_digest(const SubmapDigest& digest, Stamp now) {
  on_heard(digest.from, now);
  Neighbour& neighbour = neighbours_[digest.from];
  neighbour.hears_us = std::ranges::count(digest.hears, self_) > 0;
  if (neighbour.hears_us) neighbour.heard_by_it.push_back(now);
  while (!neighbour.heard_by_it.empty() && now - neighbour.heard_by_it.front() > config_.peer_timeout)
    neighbour.heard_by_it.pop_front();
  neighbour.digest_received = now;
  const std::vector<SeqRange> part = plausible(digest.submaps, hostile_);
  neighbour.holds =
      digest.submaps.size() < config_.max_ranges ? store::SeqSet(part) : offered_after(neighbour.holds, part);
}

bool NeighbourTable::in_reach(const AgentId& name, Stamp now) const {
  const auto neighbour = neighbours_.find(name);
  return neighbour != neighbours_.end() && now - neighbour->second.heard <= config_.peer_timeout;
}

bool NeighbourTable::hears_us(const AgentId& name, Stamp now) const {
  return in_reach(name, now) && neighbours_.at(name).hears_us;
}

bool NeighbourTable::is_near(const AgentId& name, Stamp now) const {
  if (!hears_us(name, now)) return false;
  const auto expected =
      static_cast<double>(config_.peer_timeout.count()) / static_cast<double>(config_.digest_period.count());
  const auto arrived = std::ranges::count_if(
      neighbours_.at(name).heard_by_it, [&](Stamp heard) { return now - heard <= config_.peer_timeout; });
  return static_cast<double>(arrived) >= kNearShare * expected;
}

bool NeighbourTable::lacks(const AgentId& name, const NodeId& id) const {
  const auto known = neighbours_.find(name);
  return known != neighbours_.end() && !known->second.holds.contains(id.agent, id.seq);
}

bool NeighbourTable::lacks_since(const AgentId& name, const NodeId& id, Stamp since) const {
  return lacks(name, id) && neighbours_.at(name).digest_received > since;
}

bool NeighbourTable::holds(const AgentId& name, const NodeId& id) const {
  const auto known = neighbours_.find(name);
  return known != neighbours_.end() && known->second.holds.contains(id.agent, id.seq);
}

std::vector<AgentId> NeighbourTable::in_reach(Stamp now) const {
  std::vector<AgentId> names;
  for (const auto& [name, neighbour] : neighbours_) {
    if (in_reach(name, now)) names.push_back(name);
  }
  return names;
}

std::vector<AgentId> NeighbourTable::in_sync_with(const store::Store& store, Stamp now) const {
  const store::SeqSet& held = store.submap_set();
  std::vector<AgentId> names;
  for (const auto& [name, neighbour] : neighbours_) {
    if (in_reach(name, now) && held.includes(neighbour.holds) && neighbour.holds.includes(held))
      names.push_back(name);
  }
  return names;
}

store::SeqSet NeighbourTable::offered(const store::SeqSet& lacking, std::uint64_t max, Stamp now) const {
  store::SeqSet offered;
  for (const auto& [name, neighbour] : neighbours_) {
    if (!hears_us(name, now)) continue;
    const store::SeqSet not_offered(lacking.minus(neighbour.holds));
    for (const SeqRange& range : lacking.minus(not_offered, max)) offered.insert(range);
  }
  return offered;
}

}  // namespace fleetmap::exchange
