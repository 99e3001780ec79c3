#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "fleetmap/core/ids.hpp"

namespace fleetmap::store {

/// A set of (agent, seq) kept as intervals: as small as its holes are few, whatever the numbers in it.
class SeqSet {
 public:
  SeqSet() = default;
  explicit SeqSet(const std::vector<SeqRange>& ranges);

  void insert(const AgentId& agent, std::uint32_t seq);
  /// Empty and reversed ranges change nothing.
  void insert(const SeqRange& range);
  void erase(const AgentId& agent, std::uint32_t seq);
  bool contains(const AgentId& agent, std::uint32_t seq) const;
  /// One past the greatest of `agent` in [first, end), or `first`.
  std::uint32_t end_within(const SeqRange& range) const;
  /// Every item of `other` is in this set.
  bool includes(const SeqSet& other) const;
  bool empty() const { return intervals_.empty(); }
  std::uint64_t size() const { return size_; }
  /// Maximal intervals, by agent, then first.
  std::vector<SeqRange> ranges() const;
  /// Returns the items of this set that `other` lacks: intervals as in ranges(), cut off after `limit` items.
  std::vector<SeqRange> minus(const SeqSet& other, std::uint64_t limit = UINT64_MAX) const;
  bool operator==(const SeqSet& other) const { return intervals_ == other.intervals_; }

 private:
  using Intervals = std::map<std::uint32_t, std::uint32_t>;  ///< first -> end, apart and never touching
  std::map<AgentId, Intervals> intervals_;
  std::uint64_t size_ = 0;
};

}  // namespace fleetmap::store
