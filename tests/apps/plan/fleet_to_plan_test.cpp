#include "plan/fleet_to_plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "apps/plan/farm_site.hpp"
#include "fleetmap/geometry/degree.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::HasSubstr;

const std::string kConfig = FLEETMAP_SOURCE_DIR "/config/";

TEST(FleetToPlan, WithoutAFileRobotsAreNumberedAndHaveTheMissionsSpeed) {
  const auto fleet = fleet_to_plan(kSite, "", 3, {{"mission.speed", "0.8"}});
  ASSERT_TRUE(fleet) << fleet.error().message;
  ASSERT_EQ(fleet->robots.size(), 3u);
  EXPECT_EQ(fleet->robots[0].id.str(), "r1");
  EXPECT_EQ(fleet->robots[2].id.str(), "r3");
  EXPECT_EQ(fleet->robots[1].speed, 0.8);
  EXPECT_EQ(fleet->settings.speed, 0.8);
  EXPECT_FALSE(fleet->origin);
}

TEST(FleetToPlan, FleetFileGivesAllMembersAndItsOrigin) {
  const auto fleet = fleet_to_plan(kSite, kConfig + "fleets/farm_small.yaml", 1, {});
  ASSERT_TRUE(fleet) << fleet.error().message;
  EXPECT_EQ(fleet->robots.size(), 5u) << "the number of robots is the file's";
  EXPECT_EQ(std::filesystem::path(fleet->settings.file).lexically_normal(), std::filesystem::path(kSite))
      << "the drawing of the command line, not the file's";
  ASSERT_TRUE(fleet->origin);
  EXPECT_NEAR(fleet->origin->latitude, 39.0 * kDegree, 1e-12);
}

TEST(FleetToPlan, AnAgentsFileWithoutOriginIsPlannedAboutTheDrawingsFirstPosition) {
  ::testing::internal::CaptureStdout();
  const auto fleet = fleet_to_plan(kSite, kConfig + "agents/r1.yaml", 1, {});
  const std::string said = ::testing::internal::GetCapturedStdout();
  ASSERT_TRUE(fleet) << fleet.error().message;
  EXPECT_EQ(fleet->robots.size(), 2u);
  ASSERT_TRUE(fleet->origin);
  EXPECT_NEAR(fleet->origin->latitude, 39.0 * kDegree, 0.01 * kDegree) << "the farm lies there";
  EXPECT_THAT(said, HasSubstr("r1.yaml has no site.origin"));
  ::testing::internal::CaptureStdout();
  const auto placed =
      fleet_to_plan(kSite, kConfig + "agents/r1.yaml", 1, {{"site.origin", "[39.001, -3.0, 600.0]"}});
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  ASSERT_TRUE(placed) << placed.error().message;
  EXPECT_NEAR(placed->origin->latitude, 39.001 * kDegree, 1e-12);
}

TEST(FleetToPlan, AnotherFileIsRefused) {
  const auto fleet = fleet_to_plan(kSite, kConfig + "sensors/vlp16.yaml", 1, {});
  ASSERT_FALSE(fleet);
  EXPECT_THAT(fleet.error().message, HasSubstr("vlp16.yaml"));
}

}  // namespace
}  // namespace fleetmap::apps
