#include "fleetmap/store/thinned_map.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <random>

#include "store/items.hpp"

namespace fleetmap::store {
namespace {

/// One point in each of so many voxels of 1 m along x; the western half is of agent 0, the rest of agent 1.
MapTile row(int first, int last) {
  MapTile tile;
  for (int x = first; x < last; ++x) {
    tile.cloud.points.emplace_back(static_cast<float>(x) + 0.5f, 0.5f, 0.5f);
    tile.cloud.intensities.push_back(static_cast<float>(x));
    tile.observed_by.push_back(x < 500 ? 0 : 1);
  }
  return tile;
}

MapOutline outline() {
  MapOutline outline;
  outline.submaps = 7;
  outline.points_in = 5'000;
  outline.agents = {testing::agent("a"), testing::agent("b")};
  return outline;
}

TEST(ThinnedMap, KeepsAMapThatIsSmallEnoughAsItIs) {
  ThinnedMap thinned(1.0, 1'000);
  thinned.add(row(0, 300));
  thinned.add(row(300, 1'000));
  const MergedMap map = thinned.map(outline());
  EXPECT_EQ(thinned.voxel_m(), 1.0);
  EXPECT_EQ(map.cloud.points, row(0, 1'000).cloud.points);
  EXPECT_EQ(map.cloud.intensities, row(0, 1'000).cloud.intensities);
  EXPECT_EQ(map.observed_by, row(0, 1'000).observed_by);
  EXPECT_EQ(map.submaps, 7u);
  EXPECT_EQ(map.points_in, 5'000u);
  EXPECT_EQ(map.agents, outline().agents);
}

TEST(ThinnedMap, ThinsToTheBoundAndStillTellsWhoSawAPoint) {
  ThinnedMap thinned(1.0, 300);
  for (int first = 0; first < 1'000; first += 50) thinned.add(row(first, first + 50));
  const MergedMap map = thinned.map(outline());
  EXPECT_LE(map.cloud.size(), 300u);
  EXPECT_GT(map.cloud.size(), 130u) << "one step of half more is at most 1.5 times fewer, and its grid";
  ASSERT_EQ(map.observed_by.size(), map.cloud.size());
  for (std::size_t i = 0; i < map.cloud.size(); ++i)
    EXPECT_EQ(map.observed_by[i], map.cloud.points[i].x() < 500.0f ? 0 : 1);
  EXPECT_GT(map.cloud.points.back().x(), 990.0f - static_cast<float>(thinned.voxel_m()));
}

}  // namespace
}  // namespace fleetmap::store
