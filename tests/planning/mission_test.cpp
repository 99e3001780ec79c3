#include "fleetmap/planning/mission.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fleetmap::planning {
namespace {

using ::testing::HasSubstr;

Mission three_rows() {
  Mission mission;
  mission.rows = {{4, {{0, 0}, {100, 0}}}, {7, {{0, 8}, {30, 8}, {30, 48}}}, {9, {{0, 16}, {100, 16}}}};
  return mission;
}

TEST(SelectedRows, EachNthKeepsItsId) {
  const Mission mission = with_selected_rows(three_rows(), {.every = 2});
  ASSERT_EQ(mission.rows.size(), 2u);
  EXPECT_EQ(mission.rows[0].id, 4u);
  EXPECT_EQ(mission.rows[1].id, 9u);
}

TEST(SelectedRows, LongOnesAreCutAlongTheirLengthAndLoseNothing) {
  const Mission mission = with_selected_rows(three_rows(), {.every = 1, .max_row_length = 40.0});
  ASSERT_EQ(mission.rows.size(), 8u);  // three pieces, two, three
  double length = 0.0;
  for (std::size_t k = 0; k < mission.rows.size(); ++k) {
    EXPECT_EQ(mission.rows[k].id, k);
    EXPECT_LE(length_of(mission.rows[k].waypoints), 40.0 + 1e-9);
    length += length_of(mission.rows[k].waypoints);
  }
  EXPECT_NEAR(length, 270.0, 1e-9);
  const Polyline expected = {{0, 8}, {30, 8}, {30, 13}};
  EXPECT_EQ(mission.rows[3].waypoints, expected);
  EXPECT_EQ(mission.rows[4].waypoints.front(), mission.rows[3].waypoints.back());
  EXPECT_EQ(mission.rows[4].waypoints.back(), Eigen::Vector2d(30, 48));
}

TEST(Mission, ABoundaryIsCheckedLikeAKeepOut) {
  Mission mission = three_rows();
  mission.boundary = KeepOut{{0, 0}, {1, 1}};
  EXPECT_THAT(mission.validate().error().message, HasSubstr("boundary has fewer than three corners"));
}

}  // namespace
}  // namespace fleetmap::planning
