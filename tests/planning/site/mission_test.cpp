#include "fleetmap/planning/site/mission.hpp"

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

TEST(Mission, ABoundaryIsCheckedLikeAKeepOut) {
  Mission mission = three_rows();
  mission.boundary = KeepOut{{0, 0}, {1, 1}};
  EXPECT_THAT(mission.validate().error().message, HasSubstr("boundary has fewer than three corners"));
}

}  // namespace
}  // namespace fleetmap::planning
