#include "fleetmap/cloud/voxel_sample.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace fleetmap::cloud {
namespace {

/// A cube of voxels around the origin, `edge` long.
std::vector<Voxel> cube(std::int32_t edge) {
  std::vector<Voxel> voxels;
  for (std::int32_t x = 0; x < edge; ++x) {
    for (std::int32_t y = 0; y < edge; ++y) {
      for (std::int32_t z = 0; z < edge; ++z) voxels.push_back({x - edge / 2, y - edge / 2, z - edge / 2});
    }
  }
  return voxels;
}

std::size_t with_zero_bits(const std::vector<Voxel>& voxels, unsigned level) {
  std::size_t count = 0;
  for (const Voxel& voxel : voxels) {
    if (level == 0 || hash_of(voxel) >> (64 - level) == 0) ++count;
  }
  return count;
}

TEST(SampleOfVoxels, HoldsAllOfThemUpToItsCapacity) {
  const std::vector<Voxel> voxels = cube(6);
  VoxelSample sample(voxels.size());
  for (int round = 0; round < 3; ++round) {
    for (const Voxel& voxel : voxels) sample.add(voxel);
  }
  EXPECT_EQ(sample.level(), 0u) << "repeated voxels take no room";
  EXPECT_EQ(sample.voxels().size(), voxels.size());
  sample.add({100, 100, 100});
  EXPECT_GE(sample.level(), 1u);
  EXPECT_LT(sample.voxels().size(), voxels.size());
}

/// The level is the least at which the voxels whose hash begins with so many zeros fit.
TEST(SampleOfVoxels, IsEveryVoxelWhoseHashBeginsWithAsManyZerosAsTheLevel) {
  const std::vector<Voxel> voxels = cube(18);
  for (const std::size_t capacity : {1u, 10u, 100u, 1000u, 5000u}) {
    VoxelSample sample(capacity);
    for (const Voxel& voxel : voxels) sample.add(voxel);
    ASSERT_GT(sample.level(), 0u);
    EXPECT_LE(sample.voxels().size(), capacity);
    EXPECT_GT(with_zero_bits(voxels, sample.level() - 1), capacity) << "the level is no higher than needed";
    EXPECT_EQ(sample.voxels().size(), with_zero_bits(voxels, sample.level()));
    for (const Voxel& voxel : sample.voxels()) EXPECT_EQ(hash_of(voxel) >> (64 - sample.level()), 0u);
  }
}

TEST(SampleOfVoxels, OfNoCapacityHoldsOne) {
  VoxelSample sample(0);
  EXPECT_TRUE(sample.voxels().empty());
  sample.add({1, 2, 3});
  EXPECT_EQ(sample.voxels().count({1, 2, 3}), 1u);
  EXPECT_EQ(sample.level(), 0u);
}

}  // namespace
}  // namespace fleetmap::cloud
