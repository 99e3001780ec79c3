#include "fleetmap/messages/mission_report.hpp"

#include <gtest/gtest.h>

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

TEST(RowSet, OfAnotherMissionIsCutAndFilledUp) {
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

}  // namespace
}  // namespace fleetmap::messages
