#include "fleetmap/store/seq_set.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "store/items.hpp"

namespace fleetmap::store {
namespace {

using Plain = std::set<NodeId>;

Plain plain(const std::vector<SeqRange>& ranges) {
  Plain items;
  for (const auto& range : ranges) {
    for (std::uint32_t seq = range.first; seq < range.end; ++seq) items.insert({range.agent, seq});
  }
  return items;
}

TEST(SeqSet, behaves_as_a_set_of_numbers) {
  const std::vector<AgentId> agents{testing::agent("a"), testing::agent("b")};
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    SeqSet sets[2];
    Plain expected[2];
    for (int step = 0; step < 60; ++step) {
      const std::size_t which = random() % 2;
      const AgentId& agent = agents[random() % 2];
      const auto first = static_cast<std::uint32_t>(random() % 40);
      if (random() % 4 == 0) {
        sets[which].erase(agent, first);
        expected[which].erase({agent, first});
      } else {
        const SeqRange range{agent, first, first + static_cast<std::uint32_t>(random() % 6)};
        sets[which].insert(range);
        expected[which].merge(plain({range}));
      }
      ASSERT_EQ(plain(sets[which].ranges()), expected[which]);
      ASSERT_EQ(sets[which].size(), expected[which].size());
      ASSERT_EQ(sets[which].contains(agent, first), expected[which].contains({agent, first}));
    }
    Plain difference;
    std::ranges::set_difference(expected[0], expected[1], std::inserter(difference, difference.end()));
    EXPECT_EQ(plain(sets[0].minus(sets[1])), difference);
    EXPECT_EQ(sets[1].includes(sets[0]), difference.empty());
    const Plain some = plain(sets[0].minus(sets[1], 3));
    EXPECT_EQ(some.size(), std::min<std::size_t>(3, difference.size()));
    EXPECT_TRUE(std::ranges::includes(difference, some));
    EXPECT_EQ(SeqSet(sets[0].ranges()), sets[0]);
  }
}

TEST(SeqSet, takes_hostile_ranges_in_constant_memory) {
  SeqSet set;
  set.insert({testing::agent("a"), 0, UINT32_MAX});
  set.insert({testing::agent("a"), 9, 3});
  set.insert(testing::agent("a"), UINT32_MAX);
  EXPECT_EQ(set.ranges().size(), 1u);
  EXPECT_EQ(set.size(), UINT32_MAX);
  EXPECT_EQ(set.minus(SeqSet(), 10), (std::vector<SeqRange>{{testing::agent("a"), 0, 10}}));
}

}  // namespace
}  // namespace fleetmap::store
