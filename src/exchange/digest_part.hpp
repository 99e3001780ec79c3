#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fleetmap/store/seq_set.hpp"

namespace fleetmap::exchange {

/// The same items, each range within one session: also honest robots hold items on both sides of a border
/// when a forger numbered some there.
std::vector<SeqRange> by_session(const std::vector<SeqRange>& ranges);
/// The ranges that a digest with room for `limit` of them shows: all, or a part from the `next`-th on, going
/// round. Neighbouring parts share a range, so each gap between two ranges lies within some part.
std::vector<SeqRange> next_part(const std::vector<SeqRange>& ranges, std::size_t next, std::size_t limit);
/// Begin of the part after the one that begins at `next`, among `count` ranges.
std::size_t after_part(std::size_t next, std::size_t count, std::size_t limit);

/// The ranges in the order received, without those that are reversed, beyond kEndOfSeqs or of several
/// sessions, which are counted in `hostile`, since no honest robot makes so many items that their numbers
/// reach the next session.
std::vector<SeqRange> plausible(const std::vector<SeqRange>& ranges, std::uint64_t& hostile);

/// The offer of a robot after `part` of its digest, `offered` before: between two ranges of the part that
/// follow each other it holds nothing. The names that a forged digest added are gone when the robot's own
/// digests have gone round. Begins anew with the part when a hostile robot filled the set with holes.
store::SeqSet offered_after(const store::SeqSet& offered, const std::vector<SeqRange>& part);

}  // namespace fleetmap::exchange
