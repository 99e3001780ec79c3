#include "page/row_progress.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace fleetmap::apps {
namespace {

constexpr double kNorth = std::numbers::pi / 2.0;

TEST(RowProgress, IsTheShareOfTheWayThatLiesBehind) {
  const planning::Row row{7, {{0.0, 0.0}, {30.0, 0.0}, {30.0, 10.0}}};
  EXPECT_EQ(row_progress(row, {15.0, 1.0}, 0.1), 0.375);
  EXPECT_EQ(row_progress(row, {31.0, 5.0}, kNorth), 0.875);
  EXPECT_EQ(row_progress(row, {-3.0, 0.0}, 0.0), 0.0) << "before its first waypoint";
  EXPECT_EQ(row_progress(row, {30.0, 12.0}, kNorth), 1.0);
}

TEST(RowProgress, TheHeadingTellsTheEndThatItCameFrom) {
  const planning::Row row{7, {{0.0, 0.0}, {100.0, 0.0}}};
  EXPECT_EQ(row_progress(row, {25.0, 0.5}, std::numbers::pi), 0.75);
  EXPECT_EQ(row_progress(row, {25.0, 0.5}, -0.5), 0.25);
}

TEST(RowProgress, ThereIsNoneAwayFromTheRow) {
  const planning::Row row{7, {{0.0, 0.0}, {100.0, 0.0}}};
  EXPECT_FALSE(row_progress(row, {50.0, kOffRow + 0.1}, 0.0));
  EXPECT_FALSE(row_progress(row, {-kOffRow - 0.1, 0.0}, 0.0));
  EXPECT_TRUE(row_progress(row, {50.0, kOffRow - 0.1}, 0.0));
  EXPECT_FALSE(row_progress({7, {{1.0, 1.0}, {1.0, 1.0}}}, {1.0, 1.0}, 0.0)) << "a row without length";
}

}  // namespace
}  // namespace fleetmap::apps
