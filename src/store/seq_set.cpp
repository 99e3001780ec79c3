#include "fleetmap/store/seq_set.hpp"

#include <algorithm>

namespace fleetmap::store {

SeqSet::SeqSet(const std::vector<SeqRange>& ranges) {
  for (const SeqRange& range : ranges) insert(range);
}

void SeqSet::insert(const AgentId& agent, std::uint32_t seq) {
  if (seq != UINT32_MAX) insert(SeqRange{agent, seq, seq + 1});  // the largest number has no end
}

void SeqSet::insert(const SeqRange& range) {
  if (range.first >= range.end) return;
  Intervals& intervals = intervals_[range.agent];
  std::uint32_t first = range.first;
  std::uint32_t end = range.end;
  auto it = intervals.upper_bound(first);
  if (it != intervals.begin() && std::prev(it)->second >= first) --it;
  while (it != intervals.end() && it->first <= end) {
    first = std::min(first, it->first);
    end = std::max(end, it->second);
    size_ -= it->second - it->first;
    it = intervals.erase(it);
  }
  intervals.emplace(first, end);
  size_ += end - first;
}

void SeqSet::erase(const AgentId& agent, std::uint32_t seq) {
  if (!contains(agent, seq)) return;
  Intervals& intervals = intervals_[agent];
  const auto it = std::prev(intervals.upper_bound(seq));
  const auto [first, end] = *it;
  intervals.erase(it);
  if (first < seq) intervals.emplace(first, seq);
  if (seq + 1 < end) intervals.emplace(seq + 1, end);
  --size_;
  if (intervals.empty()) intervals_.erase(agent);
}

bool SeqSet::contains(const AgentId& agent, std::uint32_t seq) const {
  const auto found = intervals_.find(agent);
  if (found == intervals_.end()) return false;
  const auto it = found->second.upper_bound(seq);
  return it != found->second.begin() && std::prev(it)->second > seq;
}

std::uint32_t SeqSet::end_within(const SeqRange& range) const {
  const auto found = intervals_.find(range.agent);
  if (found == intervals_.end()) return range.first;
  const auto after = found->second.lower_bound(range.end);
  if (after == found->second.begin()) return range.first;
  return std::clamp(std::prev(after)->second, range.first, range.end);
}

bool SeqSet::includes(const SeqSet& other) const { return other.minus(*this, 1).empty(); }

std::vector<SeqRange> SeqSet::ranges() const {
  std::vector<SeqRange> ranges;
  for (const auto& [agent, intervals] : intervals_) {
    for (const auto& [first, end] : intervals) ranges.push_back({agent, first, end});
  }
  return ranges;
}

std::vector<SeqRange> SeqSet::minus(const SeqSet& other, std::uint64_t limit) const {
  std::vector<SeqRange> rest;
  const auto take = [&](const AgentId& agent, std::uint32_t first, std::uint32_t end) {
    if (first >= end || limit == 0) return;
    const auto count = static_cast<std::uint32_t>(std::min<std::uint64_t>(end - first, limit));
    rest.push_back({agent, first, first + count});
    limit -= count;
  };
  const Intervals none;
  for (const auto& [agent, intervals] : intervals_) {
    const auto found = other.intervals_.find(agent);
    const Intervals& holes = found == other.intervals_.end() ? none : found->second;
    for (const auto& [first, end] : intervals) {
      std::uint32_t from = first;
      auto hole = holes.upper_bound(from);
      if (hole != holes.begin()) --hole;
      for (; hole != holes.end() && hole->first < end && limit > 0; ++hole) {
        if (hole->second <= from) continue;
        take(agent, from, hole->first);
        from = hole->second;
      }
      take(agent, from, end);
      if (limit == 0) return rest;
    }
  }
  return rest;
}

}  // namespace fleetmap::store
