#include "fleetmap/messages/mission_report.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace fleetmap::messages {
namespace {

TEST(RowSet, HoldsTheRowsThatWereSet) {
  RowSet rows(20);
  EXPECT_TRUE(rows.none());
  rows.set(3);
  rows.set(19);
  rows.set(24);  // beyond its last byte
  EXPECT_TRUE(rows.has(3));
  EXPECT_TRUE(rows.has(19));
  EXPECT_FALSE(rows.has(4));
  EXPECT_FALSE(rows.has(24));
  rows.set(3, false);
  EXPECT_FALSE(rows.has(3));
  EXPECT_FALSE(rows.none());
}

TEST(RowSet, RowKIsBitKModulo8OfByteKDividedBy8) {
  RowSet rows(12);
  rows.set(0);
  rows.set(9);
  EXPECT_EQ(rows.bytes(), (Bytes{1, 2}));
  EXPECT_EQ(RowSet(Bytes{1, 2}), rows);
}

TEST(RowSet, BytesOfAnotherLengthAreCutOrFilled) {
  const RowSet cut(11, Bytes{0xff, 0xff, 0xff});
  EXPECT_EQ(cut.bytes(), (Bytes{0xff, 0x07}));
  EXPECT_EQ(cut.count(), 11u);
  const RowSet filled(20, Bytes{0x80});
  EXPECT_EQ(filled.bytes(), (Bytes{0x80, 0, 0}));
  EXPECT_TRUE(RowSet(0, Bytes{0xff}).none());
}

TEST(RowSet, UnionAndIntersection) {
  RowSet a(16, Bytes{0b0011, 1});
  const RowSet b(16, Bytes{0b0110, 0});
  RowSet both = a;
  both &= b;
  EXPECT_EQ(both.bytes(), (Bytes{0b0010, 0}));
  a |= b;
  EXPECT_EQ(a.bytes(), (Bytes{0b0111, 1}));
  a &= RowSet(8, Bytes{0xff});  // of a shorter one: what it lacks is not in it
  EXPECT_EQ(a.bytes(), (Bytes{0b0111, 0}));
}

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

}  // namespace
}  // namespace fleetmap::messages
