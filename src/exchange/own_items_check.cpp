#include "own_items_check.hpp"

#include <algorithm>

namespace fleetmap::exchange {

std::uint64_t OwnItemsCheck::count_unknown(const std::vector<SeqRange>& ranges,
                                           const store::SeqSet& held) const {
  store::SeqSet own;
  for (const SeqRange& range : ranges) {
    if (range.agent == self_) own.insert(range);
  }
  std::uint64_t items = 0;
  for (const SeqRange& range : own.minus(held)) items += range.end - range.first;
  return items;
}

bool OwnItemsCheck::names_beyond(const std::vector<SeqRange>& ranges, std::uint32_t next) const {
  const std::uint32_t end = first_seq(*session_) + kItemsPerSession;
  return std::ranges::any_of(ranges, [&](const SeqRange& range) {
    return range.agent == self_ && range.first < range.end && range.end > next && range.end <= end;
  });
}

std::vector<Event> OwnItemsCheck::on_digest(const Digest& digest, const store::Store& store) {
  std::vector<Event> events;
  if (session_ && (names_beyond(digest.nodes, store.next_node_seq(*session_)) ||
                   names_beyond(digest.alignments, store.next_alignment_seq(*session_)))) {
    events.push_back(SessionTaken{digest.from});
  }
  if (reported_) return events;
  const std::uint64_t nodes = count_unknown(digest.nodes, store.node_set());
  const std::uint64_t alignments = count_unknown(digest.alignments, store.alignment_set());
  if (nodes + alignments == 0) return events;
  reported_ = true;
  events.push_back(OwnItemsElsewhere{digest.from, nodes, alignments});
  return events;
}

}  // namespace fleetmap::exchange
