#include "digest_part.hpp"

#include <algorithm>
#include <optional>

namespace fleetmap::exchange {
namespace {

using store::SeqSet;

constexpr std::size_t kMaxIntervals = 8192;

/// Names of any robots, from `from` (none: the first of all) up to `to` (none: the last of all), without
/// `to`.
struct Gap {
  std::optional<NodeId> from, to;
};

/// A part that begins again with the first range has two gaps: behind the last name and before the
/// first.
std::vector<Gap> gaps_of(const std::vector<SeqRange>& part) {
  std::vector<Gap> gaps;
  for (std::size_t k = 1; k < part.size(); ++k) {
    const NodeId end{part[k - 1].agent, part[k - 1].end}, next{part[k].agent, part[k].first};
    if (end <= next) {
      gaps.push_back({end, next});
    } else {
      gaps.push_back({end, std::nullopt});
      gaps.push_back({std::nullopt, next});
    }
  }
  return gaps;
}

/// The smallest number of `agent` that is not before `name`.
std::uint32_t number_at(const NodeId& name, const AgentId& agent) {
  if (name.agent == agent) return name.seq;
  return name.agent < agent ? 0 : kEndOfSeqs;
}

std::vector<SeqRange> without(const std::vector<SeqRange>& ranges, const Gap& gap) {
  std::vector<SeqRange> left;
  for (const SeqRange& range : ranges) {
    const std::uint32_t from = gap.from ? number_at(*gap.from, range.agent) : 0;
    const std::uint32_t to = gap.to ? number_at(*gap.to, range.agent) : kEndOfSeqs;
    if (from >= to || to <= range.first || range.end <= from) {
      left.push_back(range);
      continue;
    }
    if (range.first < from) left.push_back({range.agent, range.first, from});
    if (to < range.end) left.push_back({range.agent, to, range.end});
  }
  return left;
}

}  // namespace

std::vector<SeqRange> by_session(const std::vector<SeqRange>& ranges) {
  std::vector<SeqRange> parts;
  for (SeqRange rest : ranges) {
    for (; session_of(rest.first) != session_of(rest.end - 1); rest.first = parts.back().end)
      parts.push_back({rest.agent, rest.first, first_seq(session_of(rest.first)) + kItemsPerSession});
    parts.push_back(rest);
  }
  return parts;
}

std::vector<SeqRange> next_part(const std::vector<SeqRange>& ranges, std::size_t next, std::size_t limit) {
  std::vector<SeqRange> part;
  for (std::size_t k = 0; k < std::min(limit, ranges.size()); ++k)
    part.push_back(ranges[(next + k) % ranges.size()]);
  return part;
}

std::size_t after_part(std::size_t next, std::size_t count, std::size_t limit) {
  if (count < limit) return 0;
  return (next + std::max<std::size_t>(limit, 2) - 1) % count;
}

std::vector<SeqRange> plausible(const std::vector<SeqRange>& ranges, std::uint64_t& hostile) {
  std::vector<SeqRange> kept;
  for (const SeqRange& range : ranges) {
    const bool ordered = !range.agent.empty() && range.first < range.end && range.end <= kEndOfSeqs;
    if (ordered && session_of(range.first) == session_of(range.end - 1)) {
      kept.push_back(range);
    } else {
      ++hostile;
    }
  }
  return kept;
}

SeqSet offered_after(const SeqSet& offered, const std::vector<SeqRange>& part) {
  std::vector<SeqRange> left = offered.ranges();
  for (const Gap& gap : gaps_of(part)) left = without(left, gap);
  SeqSet after(left);
  for (const SeqRange& range : part) after.insert(range);
  return after.ranges().size() > kMaxIntervals ? SeqSet(part) : after;
}

}  // namespace fleetmap::exchange
