#include "ground_filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/field_bounds.hpp"

namespace fleetmap::output {
namespace {

using testing::kNaN;

constexpr int kWidth = 80;

/// 40 m x 40 m of terrain that rises by 10 %, with a table of panels (10 m x 4 m, 1.2 m high) on it.
std::vector<float> farm() {
  std::vector<float> low;
  for (int y = 0; y < kWidth; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const bool table = x >= 30 && x < 50 && y >= 36 && y < 44;
      low.push_back(0.05f * static_cast<float>(x) + (table ? 1.2f : 0.0f));
    }
  }
  return low;
}

std::size_t at(int x, int y) { return static_cast<std::size_t>(y * kWidth + x); }

TEST(GroundFilter, KeepsASlopeAndLeavesOutWhatStandsOnIt) {
  const std::vector<bool> ground = ground_cells(farm(), kWidth, {});
  for (int y = 0; y < kWidth; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const bool table = x >= 30 && x < 50 && y >= 36 && y < 44;
      EXPECT_EQ(ground[at(x, y)], !table) << x << ' ' << y;
    }
  }
}

TEST(GroundFilter, CellsWithoutPointsAreNoGroundAndHideNone) {
  std::vector<float> low = farm();
  // Nothing is seen around the table, as behind one that hides the ground: it is still not the ground.
  for (int y = 33; y < 47; ++y) {
    for (int x = 27; x < 53; ++x) {
      if (!(x >= 30 && x < 50 && y >= 36 && y < 44)) low[at(x, y)] = kNaN<float>;
    }
  }
  const std::vector<bool> ground = ground_cells(low, kWidth, {});
  EXPECT_FALSE(ground[at(28, 40)]);
  EXPECT_FALSE(ground[at(40, 40)]);
  EXPECT_TRUE(ground[at(20, 40)]);
  EXPECT_TRUE(ground[at(60, 40)]);
}

TEST(GroundFilter, ATerraceIsGroundUpToItsEdge) {
  std::vector<float> low;
  for (int k = 0; k < kWidth * kWidth; ++k) low.push_back(k % kWidth < 40 ? 1.5f : 0.0f);
  const std::vector<bool> ground = ground_cells(low, kWidth, {});
  EXPECT_EQ(std::ranges::count(ground, false), 0);
}

TEST(GroundFilter, APitOfAReflectionTakesNoGroundWithIt) {
  std::vector<float> low = farm();
  low[at(10, 10)] = -7.0f;
  const std::vector<bool> ground = ground_cells(low, kWidth, {});
  EXPECT_FALSE(ground[at(10, 10)]);
  for (const auto& [x, y] : {std::pair{9, 10}, {11, 10}, {10, 9}, {10, 11}, {12, 12}})
    EXPECT_TRUE(ground[at(x, y)]);
}

TEST(GroundFilter, AnEmptyRasterHasNone) {
  EXPECT_TRUE(ground_cells({}, 0, {}).empty());
  EXPECT_EQ(ground_cells({kNaN<float>, 1.0f}, 2, {}), (std::vector<bool>{false, true}));
}

}  // namespace
}  // namespace fleetmap::output
