#include "fingerprint_sums.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>

#include "store/items.hpp"

namespace fleetmap::store {
namespace {

const AgentId kMakers[] = {testing::agent("r1"), testing::agent("r2"), testing::agent("r3")};

/// The same by a visit to each.
std::uint32_t plain_sum(const std::map<NodeId, std::uint32_t>& prints, const SeqRange& range) {
  std::uint32_t sum = 0;
  for (const auto& [name, print] : prints) {
    if (name.agent == range.agent && name.seq >= range.first && name.seq < range.end) sum += print;
  }
  return sum;
}

TEST(FingerprintSums, OfAnyRangeIsTheSumOfItsItems) {
  std::mt19937 random(1);
  std::map<NodeId, std::uint32_t> prints;
  FingerprintSums sums;
  const auto maker = [&] { return kMakers[random() % 3]; };
  for (int k = 0; k < 3000; ++k) {
    // Some get another print later on, as names do that become contested.
    const NodeId name{maker(), static_cast<std::uint32_t>(random() % 2000)};
    prints[name] = static_cast<std::uint32_t>(random());
    sums.set(name, prints[name]);
  }
  for (int k = 0; k < 2000; ++k) {
    const auto first = static_cast<std::uint32_t>(random() % 2100);
    const auto length = static_cast<std::uint32_t>(random() % (k % 2 == 0 ? 300 : 2100));
    const SeqRange range{maker(), first, first + length};
    ASSERT_EQ(sums.of(range), plain_sum(prints, range)) << first << " to " << first + length;
  }
}

TEST(FingerprintSums, BordersOfBlocksAreNoBorders) {
  FingerprintSums sums;
  for (std::uint32_t seq = 0; seq < 1024; ++seq) sums.set({kMakers[0], seq}, 1);
  for (const std::uint32_t first : {0u, 1u, 255u, 256u, 257u, 511u, 512u}) {
    for (const std::uint32_t end : {512u, 513u, 767u, 768u, 769u, 1024u, 5000u})
      EXPECT_EQ(sums.of({kMakers[0], first, end}), std::min(end, 1024u) - first) << first << " to " << end;
  }
}

TEST(FingerprintSums, NothingIsSummedToZero) {
  FingerprintSums sums;
  sums.set({kMakers[1], 700}, 5);
  EXPECT_EQ(sums.of({kMakers[1], 0, 700}), 0u);
  EXPECT_EQ(sums.of({kMakers[1], 701, kEndOfSeqs}), 0u);
  EXPECT_EQ(sums.of({kMakers[1], 700, 700}), 0u);
  EXPECT_EQ(sums.of({kMakers[1], 900, 10}), 0u) << "a reversed range";
  EXPECT_EQ(sums.of({kMakers[0], 0, kEndOfSeqs}), 0u) << "another maker";
  EXPECT_EQ(sums.of({kMakers[1], 0, kEndOfSeqs}), 5u);
}

TEST(FingerprintSums, GoRoundAtTheTopOfTheirNumbersAndOfTheNames) {
  FingerprintSums sums;
  sums.set({kMakers[0], 0xfffffffe}, 0xffffffff);
  sums.set({kMakers[0], 0xfffffff0}, 3);
  EXPECT_EQ(sums.of({kMakers[0], 0xfffffff0, 0xffffffff}), 2u);
  EXPECT_EQ(sums.of({kMakers[0], 0xfffffff1, 0xffffffff}), 0xffffffffu);
  EXPECT_EQ(sums.of({kMakers[0], 0xffff0000, 0xffffffff}), 2u);
}

}  // namespace
}  // namespace fleetmap::store
