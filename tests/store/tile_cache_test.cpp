#include "fleetmap/store/tile_cache.hpp"

#include <gtest/gtest.h>

namespace fleetmap::store {
namespace {

cloud::PointCloud points(std::size_t count) {
  cloud::PointCloud cloud;
  cloud.points.assign(count, Eigen::Vector3f::Ones());
  return cloud;
}

TEST(TileCache, GivesEachPartOnce) {
  TileCache cache(1'000);
  cache.put(4, {{1, points(2)}, {3, points(5)}});
  EXPECT_EQ(cache.bytes(), 84u);
  EXPECT_TRUE(cache.take(4, 2).empty());
  EXPECT_EQ(cache.take(4, 1).size(), 2u);
  EXPECT_TRUE(cache.holds(4));
  EXPECT_EQ(cache.take(4, 3).size(), 5u);
  EXPECT_FALSE(cache.holds(4));
  EXPECT_EQ(cache.bytes(), 0u);
  EXPECT_EQ(cache.peak_bytes(), 84u);
}

TEST(TileCache, EvictsWhatIsNeededLast) {
  TileCache cache(240);
  cache.put(0, {{5, points(10)}});
  cache.put(1, {{9, points(4)}, {10, points(4)}});
  EXPECT_EQ(cache.bytes(), 216u);
  cache.put(2, {{6, points(3)}});
  EXPECT_TRUE(cache.holds(0));
  EXPECT_FALSE(cache.holds(1));
  EXPECT_TRUE(cache.holds(2));
  cache.put(3, {{20, points(10)}});
  EXPECT_FALSE(cache.holds(3)) << "it is needed last itself";
  EXPECT_EQ(cache.bytes(), 156u);
  cache.clear();
  EXPECT_FALSE(cache.holds(0));
  EXPECT_EQ(cache.bytes(), 0u);
  EXPECT_LE(cache.peak_bytes(), 240u);
}

}  // namespace
}  // namespace fleetmap::store
