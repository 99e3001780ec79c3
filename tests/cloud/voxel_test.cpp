#include "fleetmap/cloud/voxel.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <set>

namespace fleetmap::cloud {
namespace {

TEST(Voxel, IndexIsTheFloorOfEachCoordinate) {
  EXPECT_EQ(voxel_of({0.0f, 0.49f, 0.5f}, 0.5), (Voxel{0, 0, 1}));
  EXPECT_EQ(voxel_of({-0.01f, -0.5f, -0.51f}, 0.5), (Voxel{-1, -1, -2}));
}

TEST(Voxel, PointsThatHaveNoIndexAreRefused) {
  EXPECT_FALSE(voxel_of({std::numeric_limits<float>::quiet_NaN(), 0.0f, 0.0f}, 1.0));
  EXPECT_FALSE(voxel_of({0.0f, std::numeric_limits<float>::infinity(), 0.0f}, 1.0));
  EXPECT_FALSE(voxel_of({0.0f, 0.0f, 3e9f}, 1.0));
  EXPECT_FALSE(voxel_of({0.0f, 0.0f, -3e9f}, 1.0));
  EXPECT_TRUE(voxel_of({0.0f, 0.0f, -2e9f}, 1.0));
}

TEST(Voxel, HashesOfNeighboursDifferInHalfOfTheirBits) {
  std::set<std::uint64_t> hashes;
  double bits = 0.0;
  for (std::int32_t x = -8; x < 8; ++x) {
    for (std::int32_t y = -8; y < 8; ++y) {
      for (std::int32_t z = -8; z < 8; ++z) {
        const std::uint64_t hash = hash_of({x, y, z});
        hashes.insert(hash);
        bits += std::popcount(hash ^ hash_of({x + 1, y, z})) + std::popcount(hash ^ hash_of({x, y, z + 1}));
      }
    }
  }
  EXPECT_EQ(hashes.size(), 4096u);
  EXPECT_NEAR(bits / (2 * 4096), 32.0, 1.0);
}

}  // namespace
}  // namespace fleetmap::cloud
