#include "solver/block_pattern.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numeric>
#include <random>

namespace fleetmap::graph {
namespace {

using Pairs = std::vector<std::pair<int, int>>;

/// Non-zero blocks of the Cholesky factor of a dense matrix with these pairs: eliminating a variable connects
/// all its neighbours.
std::vector<std::vector<bool>> eliminated(std::size_t variables, const Pairs& pairs, const BlockPattern& L) {
  std::vector<std::vector<bool>> filled(variables, std::vector<bool>(variables, false));
  for (const auto& [i, j] : pairs) {
    const auto a = static_cast<std::size_t>(L.column_of(i)), b = static_cast<std::size_t>(L.column_of(j));
    filled[std::max(a, b)][std::min(a, b)] = true;
  }
  for (std::size_t k = 0; k < variables; ++k) {
    for (std::size_t i = k + 1; i < variables; ++i) {
      for (std::size_t j = k + 1; j < i; ++j) {
        if (filled[i][k] && filled[j][k]) filled[i][j] = true;
      }
    }
  }
  return filled;
}

TEST(BlockPattern, HasTheBlocksThatTheEliminationFillsAndNoOthers) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    std::vector<int> dims, permutation(25);
    for (int i = 0; i < 25; ++i) dims.push_back(random() % 2 == 0 ? 3 : 6);
    Pairs pairs;
    for (int k = 0; k < 40; ++k) {
      const int i = static_cast<int>(random() % 25), j = static_cast<int>(random() % 25);
      if (i != j) pairs.emplace_back(i, j);
    }
    std::iota(permutation.begin(), permutation.end(), 0);
    std::ranges::shuffle(permutation, random);
    for (const auto& order : {std::vector<int>(), permutation}) {
      const BlockPattern L(dims, pairs, order);
      const auto filled = eliminated(dims.size(), pairs, L);
      std::vector<bool> covered(L.values(), false);
      const auto cover = [&](std::size_t at, int elements) {
        for (int e = 0; e < elements; ++e) {
          ASSERT_LT(at + static_cast<std::size_t>(e), covered.size());
          EXPECT_FALSE(covered[at + static_cast<std::size_t>(e)]) << "two blocks overlap";
          covered[at + static_cast<std::size_t>(e)] = true;
        }
      };
      for (int j = 0; j < 25; ++j) {
        cover(L.find(j, j).value(), L.column(j).dim * L.column(j).dim);
        for (int i = j + 1; i < 25; ++i) {
          const auto at = L.find(i, j);
          ASSERT_EQ(at.has_value(), filled[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)])
              << "seed " << seed << ", row " << i << ", column " << j;
          if (at) cover(*at, L.column(i).dim * L.column(j).dim);
        }
      }
      EXPECT_EQ(std::ranges::count(covered, false), 0) << "values that belong to no block";
    }
  }
}

TEST(BlockPattern, EliminatesInTheOrderThatIsSet) {
  const BlockPattern L({6, 3, 6}, {{0, 1}, {1, 2}}, {2, 0, 1});
  EXPECT_EQ(L.column_of(2), 0);
  EXPECT_EQ(L.column_of(0), 1);
  EXPECT_EQ(L.column_of(1), 2);
  EXPECT_EQ(L.column(2).dim, 3);
  EXPECT_EQ(L.offset(1), 6u) << "vectors keep the order of the variables";
  EXPECT_EQ(L.size(), 15u);
}

TEST(BlockPattern, MinimumDegreeLeavesTheHubOfAStarToTheEnd) {
  const Pairs star{{0, 1}, {0, 2}, {0, 3}, {0, 4}};
  const BlockPattern L({6, 6, 6, 6, 6}, star, {});
  EXPECT_GE(L.column_of(0), 3) << "the hub goes with the last of its neighbours";
  EXPECT_EQ(L.rows().size(), star.size()) << "a tree fills nothing";
}

TEST(BlockPattern, ParentsLeadToTheRootOfEachComponent) {
  // A path of three variables, eliminated from one end, and one that nothing connects with it.
  const BlockPattern L({6, 6, 6, 3}, {{0, 1}, {1, 2}}, {0, 1, 2, 3});
  EXPECT_EQ(L.parent(0), 1);
  EXPECT_EQ(L.parent(1), 2);
  EXPECT_EQ(L.parent(2), -1);
  EXPECT_EQ(L.root(0), 2);
  EXPECT_EQ(L.root(3), 3);
}

}  // namespace
}  // namespace fleetmap::graph
