#include "fleetmap/planning/mission/mission_progress.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace fleetmap::planning {
namespace {

constexpr std::size_t kRows = 43;

std::set<std::size_t> rows_of(const RowSet& set) {
  std::set<std::size_t> rows;
  for (std::size_t row = 0; row < 2 * kRows; ++row) {
    if (set.has(row)) rows.insert(row);
  }
  return rows;
}

TEST(RowSet, IsASet) {
  std::mt19937_64 random(9);
  for (int trial = 0; trial < 50; ++trial) {
    RowSet a(kRows), b(kRows);
    std::set<std::size_t> in_a, in_b;
    for (int k = 0; k < 60; ++k) {
      const std::size_t row = random() % kRows;
      const bool value = random() % 3 != 0;
      RowSet& set = k % 2 == 0 ? a : b;
      std::set<std::size_t>& rows = k % 2 == 0 ? in_a : in_b;
      set.set(row, value);
      value ? void(rows.insert(row)) : void(rows.erase(row));
    }
    EXPECT_EQ(rows_of(a), in_a);
    EXPECT_EQ(a.count(), in_a.size());
    EXPECT_EQ(a.none(), in_a.empty());
    std::set<std::size_t> both, either = in_a;
    for (const std::size_t row : in_b) {
      either.insert(row);
      if (in_a.contains(row)) both.insert(row);
    }
    RowSet joined = a, common = a;
    joined |= b;
    common &= b;
    EXPECT_EQ(rows_of(joined), either);
    EXPECT_EQ(rows_of(common), both);
    EXPECT_EQ(RowSet(kRows, a.bytes()), a);
  }
}

TEST(RowSet, BytesOfStrangersAreCutToTheMission) {
  const std::vector<std::uint8_t> all(200, 0xff);
  EXPECT_EQ(RowSet(kRows, all).count(), kRows);
  EXPECT_EQ(RowSet(kRows, {}).count(), 0u);
  EXPECT_EQ(RowSet(kRows, {}).bytes().size(), RowSet(kRows).bytes().size());
  RowSet set(kRows);
  set.set(kRows + 100);
  EXPECT_TRUE(set.none());
}

TEST(RowSet, WhatIsMissingInTheOtherIsNotInTheIntersection) {
  RowSet set(kRows);
  set.set(40);
  set &= RowSet(8);
  EXPECT_TRUE(set.none());
}

}  // namespace
}  // namespace fleetmap::planning
