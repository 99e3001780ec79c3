#include "fleetmap/planning/site/mission.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planning/sites.hpp"

namespace fleetmap::planning {
namespace {

using ::testing::HasSubstr;
using testing::three_rows;

TEST(Mission, ABoundaryIsCheckedLikeAKeepOut) {
  Mission mission = three_rows();
  mission.boundary = KeepOut{{0, 0}, {1, 1}};
  EXPECT_THAT(mission.validate().error().message, HasSubstr("boundary has fewer than three corners"));
}

}  // namespace
}  // namespace fleetmap::planning
