#include "fleetmap/planning/site/row_selection.hpp"

#include <gtest/gtest.h>

#include "planning/sites.hpp"

namespace fleetmap::planning {
namespace {

using testing::three_rows;

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
  const Polyline expected = {{30, 13}, {30, 8}, {0, 8}};  // the second row runs back
  EXPECT_EQ(mission.rows[3].waypoints.front(), Eigen::Vector2d(30, 48));
  EXPECT_EQ(mission.rows[4].waypoints.front(), mission.rows[3].waypoints.back());
  EXPECT_EQ(mission.rows[4].waypoints, expected);
}

TEST(SelectedRows, PiecesOfCutRowsFollowEachOtherAsOnePath) {
  Mission lanes;
  for (int k = 0; k < 5; ++k) lanes.rows.push_back({static_cast<RowId>(k), {{0, 4.0 * k}, {50, 4.0 * k}}});
  const Mission mission = with_selected_rows(lanes, {.every = 2, .max_row_length = 12.0});
  ASSERT_EQ(mission.rows.size(), 15u);  // rows 0, 2 and 4, each in five pieces of 10 m
  for (std::size_t k = 0; k < mission.rows.size(); ++k) {
    EXPECT_NEAR(length_of(mission.rows[k].waypoints), 10.0, 1e-9);
    if (k == 0) continue;
    const Eigen::Vector2d gap = mission.rows[k].waypoints.front() - mission.rows[k - 1].waypoints.back();
    EXPECT_NEAR(gap.norm(), k % 5 == 0 ? 8.0 : 0.0, 1e-9) << k;  // to the next row that is driven
  }
}

TEST(SelectedRows, WholeRowsKeepTheirDirection) {
  const Mission mission = with_selected_rows(three_rows(), {});
  EXPECT_EQ(mission.rows[2].waypoints, three_rows().rows[2].waypoints);
}

}  // namespace
}  // namespace fleetmap::planning
