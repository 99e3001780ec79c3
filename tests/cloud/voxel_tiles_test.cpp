#include "fleetmap/cloud/voxel_tiles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <random>
#include <set>
#include <vector>

namespace fleetmap::cloud {
namespace {

constexpr std::int32_t kFarthest = 2147483647;

/// Distinct voxels of a slab around the origin, with a few far outliers.
std::vector<Voxel> slab(int count, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<std::int32_t> wide(-300, 299), low(-10, 20);
  std::map<std::array<std::int32_t, 3>, Voxel> voxels;
  while (static_cast<int>(voxels.size()) < count) {
    const Voxel v{wide(random), wide(random), low(random)};
    voxels.emplace(std::array{v.x, v.y, v.z}, v);
  }
  for (const Voxel& v : {Voxel{kFarthest, 0, 0}, Voxel{-kFarthest, -kFarthest, 7}, Voxel{5, 1'000'000, 0}})
    voxels.emplace(std::array{v.x, v.y, v.z}, v);
  std::vector<Voxel> all;
  for (const auto& [key, voxel] : voxels) all.push_back(voxel);
  std::ranges::shuffle(all, random);
  return all;
}

VoxelSample sample_of(const std::vector<Voxel>& voxels, std::size_t capacity) {
  VoxelSample sample(capacity);
  for (const Voxel& voxel : voxels) sample.add(voxel);
  return sample;
}

std::vector<std::size_t> contents(const VoxelTiles& tiles, const std::vector<Voxel>& voxels) {
  std::vector<std::size_t> counts(tiles.size());
  for (const Voxel& voxel : voxels) ++counts.at(tiles.tile_of(column_code(voxel)));
  return counts;
}

TEST(ColumnCode, NamesTheSquareOfEverySizeThatAColumnLiesIn) {
  std::mt19937 random(1);
  std::uniform_int_distribution<std::int32_t> any(-kFarthest, kFarthest), near(-3, 3);
  for (int round = 0; round < 2'000; ++round) {
    const Voxel a{round % 2 == 0 ? near(random) : any(random), near(random), any(random)};
    const Voxel b{std::clamp(a.x, -kFarthest + 3, kFarthest - 3) + near(random), near(random), any(random)};
    for (int k = 0; k < 32; ++k) {
      const bool same_square = a.x >> k == b.x >> k && a.y >> k == b.y >> k;
      EXPECT_EQ(column_code(a) >> 2 * k == column_code(b) >> 2 * k, same_square);
    }
  }
}

TEST(ColumnCode, GoesOnAcrossTheOrigin) {
  EXPECT_LT(column_code({-1, -1, 0}), column_code({0, -1, 0}));
  EXPECT_LT(column_code({0, -1, 0}), column_code({-1, 0, 0}));
  EXPECT_LT(column_code({-1, 0, 0}), column_code({0, 0, 0}));
}

TEST(VoxelTiles, HoldNoMoreThanTheBoundAndWasteLittle) {
  const std::vector<Voxel> voxels = slab(20'000, 2);
  for (const std::size_t max_count : {std::size_t{300}, std::size_t{1'999}, std::size_t{100'000}}) {
    const VoxelTiles tiles(sample_of(voxels, 1'000'000), max_count);
    const auto counts = contents(tiles, voxels);
    for (const std::size_t count : counts) {
      EXPECT_LE(count, max_count);
      EXPECT_GT(count, 0u);
    }
    EXPECT_LE(tiles.size(), 1 + voxels.size() / (max_count - 40)) << "a column holds at most 31";
  }
}

TEST(VoxelTiles, AreBoundedThoughOnlyASampleIsKnown) {
  const std::vector<Voxel> voxels = slab(60'000, 3);
  const VoxelSample sample = sample_of(voxels, 4'000);
  ASSERT_GT(sample.level(), 3u);
  const VoxelTiles tiles(sample, 10'000);
  for (const std::size_t count : contents(tiles, voxels)) EXPECT_LE(count, 10'000u);
  EXPECT_GE(tiles.size(), 7u);
  EXPECT_LE(tiles.size(), 10u);
}

TEST(VoxelTiles, DivideTheCurveWithoutGaps) {
  const VoxelTiles tiles(sample_of(slab(5'000, 4), 1'000'000), 400);
  EXPECT_EQ(tiles.first_code(0), 0u);
  EXPECT_EQ(tiles.last_code(tiles.size() - 1), ~std::uint64_t{0});
  for (std::size_t tile = 0; tile < tiles.size(); ++tile) {
    EXPECT_EQ(tiles.tile_of(tiles.first_code(tile)), tile);
    EXPECT_EQ(tiles.tile_of(tiles.last_code(tile)), tile);
    if (tile + 1 < tiles.size()) {
      EXPECT_EQ(tiles.last_code(tile) + 1, tiles.first_code(tile + 1));
    }
  }
}

TEST(VoxelTiles, DoNotDivideAColumn) {
  std::vector<Voxel> voxels;
  for (std::int32_t z = 0; z < 50; ++z) voxels.push_back({3, 3, z});
  for (std::int32_t x = 0; x < 8; ++x) voxels.push_back({x, 0, 0});
  const VoxelTiles tiles(sample_of(voxels, 1'000), 4);
  EXPECT_EQ(tiles.first_code(tiles.tile_of(column_code({3, 3, 0}))), column_code({3, 3, 0}));
  EXPECT_GE(tiles.size(), 3u);
  EXPECT_EQ(VoxelTiles(VoxelSample(10), 4).size(), 1u);
}

TEST(VoxelSample, DependsOnTheSetOfVoxelsAlone) {
  std::vector<Voxel> voxels = slab(10'000, 5);
  const VoxelSample once = sample_of(voxels, 700);
  std::ranges::reverse(voxels);
  voxels.insert(voxels.end(), voxels.begin(), voxels.begin() + 6'000);
  const VoxelSample again = sample_of(voxels, 700);
  EXPECT_EQ(once.level(), again.level());
  EXPECT_EQ(once.voxels(), again.voxels());
  EXPECT_LE(once.voxels().size(), 700u);
}

TEST(VoxelSample, StandsForTheNumberOfDistinctVoxels) {
  const std::vector<Voxel> voxels = slab(100'000, 6);
  const VoxelSample sample = sample_of(voxels, 8'192);
  const auto estimate = static_cast<double>(sample.voxels().size() << sample.level());
  EXPECT_NEAR(estimate / static_cast<double>(voxels.size()), 1.0, 0.06) << "3 sigma";
  EXPECT_EQ(sample_of(voxels, 200'000).voxels().size(), voxels.size());
}

TEST(ColumnFootprint, TouchesWhatItsColumnsDo) {
  const std::vector<Voxel> voxels = slab(400, 7);
  ColumnFootprint footprint;
  std::set<std::uint64_t> squares;
  for (const Voxel& voxel : voxels) {
    footprint.add(column_code(voxel));
    squares.insert(column_code(voxel) >> 6);
  }
  footprint.finish();
  std::mt19937_64 random(8);
  int touched = 0;
  for (int round = 0; round < 2'000; ++round) {
    const std::uint64_t first = column_code(voxels[random() % voxels.size()]) + random() % 2'000 - 1'000;
    const std::uint64_t last = first + random() % 400;
    const bool expected = std::ranges::any_of(
        squares, [&](std::uint64_t square) { return first >> 6 <= square && square <= last >> 6; });
    EXPECT_EQ(footprint.touches(first, last), expected);
    touched += expected ? 1 : 0;
  }
  EXPECT_GT(touched, 200);
  EXPECT_LT(touched, 1'800);
  ColumnFootprint nothing;
  nothing.finish();
  EXPECT_FALSE(nothing.touches(0, ~std::uint64_t{0}));
}

TEST(ColumnFootprint, ThatIsTooWideForItsSquaresStillTouchesAllOfItsColumns) {
  std::mt19937 random(9);
  std::uniform_int_distribution<std::int32_t> any(-1'000'000, -1);
  ColumnFootprint footprint(16);
  std::vector<std::uint64_t> codes;
  for (int k = 0; k < 3'000; ++k) codes.push_back(column_code({any(random), any(random), 0}));
  for (const std::uint64_t code : codes) footprint.add(code);
  footprint.finish();
  for (const std::uint64_t code : codes) EXPECT_TRUE(footprint.touches(code, code));
  for (const Voxel& far : {Voxel{100'000'000, 5, 0}, Voxel{-100'000'000, -5, 0}})
    EXPECT_FALSE(footprint.touches(column_code(far), column_code(far)));
}

}  // namespace
}  // namespace fleetmap::cloud
