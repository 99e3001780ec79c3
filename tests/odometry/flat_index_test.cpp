#include "fleetmap/odometry/flat_index.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

namespace fleetmap::odometry {
namespace {

TEST(CellKey, UnpacksToTheCellThatWasPacked) {
  constexpr std::int64_t kMax = (1 << 20) - 1;
  for (const std::int64_t x : {-kMax - 1, std::int64_t{-1}, std::int64_t{0}, kMax}) {
    for (const std::int64_t y : {-kMax, std::int64_t{-7}, kMax}) {
      for (const std::int64_t z : {-kMax - 1, std::int64_t{1}, kMax}) {
        const Eigen::Vector3d cell(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
        EXPECT_EQ(unpack_cell(pack_cell(x, y, z)), cell);
      }
    }
  }
}

TEST(FastFloor, IsTheFloor) {
  for (const double value : {0.0, 0.5, 1.0, 1.999999, -0.5, -1.0, -1.000001, -0.0, 1e-300, -1e-300, 123456.75,
                             -123456.75, 9.9e15, -9.9e15}) {
    EXPECT_EQ(static_cast<double>(fast_floor(value)), std::floor(value)) << value;
  }
}

TEST(FlatIndex, NumbersCellsInOrderOfInsertion) {
  FlatIndex index;
  EXPECT_EQ(index.find(pack_cell(1, 2, 3)), FlatIndex::kAbsent);
  EXPECT_EQ(index.insert(pack_cell(1, 2, 3)), 0u);
  EXPECT_EQ(index.insert(pack_cell(3, 2, 1)), 1u);
  EXPECT_EQ(index.insert(pack_cell(1, 2, 3)), 0u) << "it is there";
  EXPECT_EQ(index.size(), 2u);
  EXPECT_EQ(index.find(pack_cell(3, 2, 1)), 1u);
  EXPECT_EQ(index.find(pack_cell(2, 2, 2)), FlatIndex::kAbsent);
}

/// Key 0 is a cell as well, and free slots hold it.
TEST(FlatIndex, TheCellWhoseKeyIsZeroIsNotThereFromTheStart) {
  FlatIndex index;
  EXPECT_EQ(index.find(0), FlatIndex::kAbsent);
  EXPECT_EQ(index.insert(0), 0u);
  EXPECT_EQ(index.find(0), 0u);
}

TEST(FlatIndex, AgreesWithAMapWhileItGrowsAndAfterItWasCleared) {
  std::mt19937 random(1);
  FlatIndex index;
  for (int round = 0; round < 3; ++round) {
    std::map<CellKey, std::uint32_t> expected;
    for (int k = 0; k < 30'000; ++k) {
      const auto axis = [&] { return static_cast<std::int64_t>(random() % 30) - 15; };
      const CellKey key = pack_cell(axis(), axis(), axis());
      const auto size = static_cast<std::uint32_t>(expected.size());
      ASSERT_EQ(index.insert(key), expected.try_emplace(key, size).first->second);
    }
    ASSERT_EQ(index.size(), expected.size());
    std::map<CellKey, std::uint32_t> visited;
    index.for_each([&](CellKey key, std::uint32_t i) { visited[key] = i; });
    EXPECT_EQ(visited, expected);
    for (std::int64_t x = -16; x <= 15; ++x) {
      const auto found = expected.find(pack_cell(x, x, -x));
      EXPECT_EQ(index.find(pack_cell(x, x, -x)),
                found == expected.end() ? FlatIndex::kAbsent : found->second);
    }
    const CellKey gone = expected.begin()->first;
    index.clear();
    EXPECT_EQ(index.size(), 0u);
    EXPECT_EQ(index.find(gone), FlatIndex::kAbsent);
    index.for_each([](CellKey, std::uint32_t) { ADD_FAILURE() << "it was cleared"; });
  }
}

TEST(FlatIndex, ClearingForFewCellsGivesMemoryBack) {
  FlatIndex index;
  const std::size_t initial = index.bytes();
  for (std::int64_t x = 0; x < 50'000; ++x) index.insert(pack_cell(x, 0, 0));
  const std::size_t grown = index.bytes();
  EXPECT_GT(grown, 8 * initial);
  index.clear();
  EXPECT_EQ(index.bytes(), grown);
  index.clear_for(20'000);
  const std::size_t some = index.bytes();
  EXPECT_LT(some, grown);
  EXPECT_EQ(index.find(pack_cell(5, 0, 0)), FlatIndex::kAbsent);
  for (std::int64_t x = 0; x < 20'000; ++x) index.insert(pack_cell(x, 0, 0));
  EXPECT_EQ(index.bytes(), some) << "there is room for those it was cleared for";
  EXPECT_EQ(index.find(pack_cell(19'999, 0, 0)), 19'999u);
  index.clear_for(0);
  EXPECT_EQ(index.bytes(), initial);
}

}  // namespace
}  // namespace fleetmap::odometry
