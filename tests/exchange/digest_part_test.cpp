#include "digest_part.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "store/items.hpp"

namespace fleetmap::exchange {
namespace {

using store::SeqSet;
using testing::agent;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

const AgentId kA = agent("r1"), kB = agent("r2"), kC = agent("r3");

/// Every second number, so that nothing joins.
std::vector<SeqRange> held_by_three(std::uint32_t each) {
  std::vector<SeqRange> ranges;
  for (const AgentId& maker : {kA, kB, kC}) {
    for (std::uint32_t k = 0; k < each; ++k) ranges.push_back({maker, 10 + 2 * k, 11 + 2 * k});
  }
  return ranges;
}

/// The offer after `digests` digests of `held`, which have room for `limit` ranges.
SeqSet after_digests(SeqSet offered, const std::vector<SeqRange>& held, std::size_t limit,
                     std::size_t digests) {
  std::size_t next = 0;
  for (std::size_t k = 0; k < digests; ++k) {
    offered = offered_after(offered, next_part(held, next, limit));
    next = after_part(next, held.size(), limit);
  }
  return offered;
}

TEST(DigestPart, PartsGoRoundAndShareARange) {
  const auto held = held_by_three(2);
  EXPECT_THAT(next_part(held, 0, 3), ElementsAre(held[0], held[1], held[2]));
  EXPECT_EQ(after_part(0, 6, 3), 2u);
  EXPECT_THAT(next_part(held, 4, 3), ElementsAre(held[4], held[5], held[0]));
  EXPECT_EQ(after_part(4, 6, 3), 0u);
  EXPECT_EQ(after_part(0, 2, 3), 0u) << "all fit";
  EXPECT_THAT(next_part({}, 5, 3), IsEmpty());
}

TEST(DigestPart, PartsBringAllThatIsHeld) {
  for (const std::size_t limit : {3u, 7u, 15u, 28u}) {
    const auto held = held_by_three(10);
    const std::size_t digests = held.size() / (limit - 1) + 2;
    EXPECT_EQ(after_digests({}, held, limit, digests), SeqSet(held)) << limit;
  }
}

/// Wherever they lie: before, between, behind and beyond the names of the robots that are held.
TEST(DigestPart, NamesOfAForgedDigestAreGoneOnceAllPartsCame) {
  const SeqSet forged({{agent("a"), 0, 9},
                       {kA, 0, 5},
                       {kA, 13, 14},
                       {kA, 500, 9000},
                       {kB, 0, first_seq(1)},
                       {kC, 21, 22},
                       {kC, first_seq(40), first_seq(40) + 5},
                       {agent("z"), 3, 4}});
  for (const std::size_t limit : {3u, 7u, 15u, 28u, 30u}) {
    const auto held = held_by_three(10);
    const std::size_t digests = 2 * held.size() / (limit - 1) + 2;
    EXPECT_EQ(after_digests(forged, held, limit, digests), SeqSet(held)) << limit;
  }
}

TEST(DigestPart, OnePartCorrectsNothingBesideIt) {
  const SeqSet before({{kA, 0, 5}, {kA, 20, 25}, {kB, 7, 9}});
  const SeqSet after = offered_after(before, {{kA, 10, 12}, {kA, 22, 23}});
  EXPECT_EQ(after, SeqSet({{kA, 0, 5}, {kA, 10, 12}, {kA, 22, 25}, {kB, 7, 9}}));
}

TEST(DigestPart, AHostileRobotFillsNoMemoryWithHoles) {
  constexpr std::uint32_t kInADigest = 25;
  SeqSet offered;
  std::size_t max_ranges = 0;
  for (std::uint32_t k = 0; k < 9000; k += kInADigest) {
    std::vector<SeqRange> part;
    for (std::uint32_t i = k; i < k + kInADigest; ++i) part.push_back({kA, 2 * i, 2 * i + 1});
    offered = offered_after(offered, part);
    max_ranges = std::max(max_ranges, offered.ranges().size());
  }
  EXPECT_LE(max_ranges, 8192u);
  EXPECT_GT(max_ranges, 8000u) << "or no limit was reached";
}

TEST(DigestPart, ARangeStaysInOneSession) {
  const std::uint32_t border = first_seq(8);
  EXPECT_THAT(
      by_session({{kA, border - 2, border + 1}, {kB, 3, 4}}),
      ElementsAre(SeqRange{kA, border - 2, border}, SeqRange{kA, border, border + 1}, SeqRange{kB, 3, 4}));
  std::uint64_t hostile = 0;
  EXPECT_THAT(plausible({{kA, border - 2, border + 1}, {kA, 5, 5}, {kB, 3, 4}, {AgentId{}, 0, 1}}, hostile),
              ElementsAre(SeqRange{kB, 3, 4}));
  EXPECT_EQ(hostile, 3u);
}

}  // namespace
}  // namespace fleetmap::exchange
