#include "fleetmap/config/mission_settings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fleetmap::config {
namespace {

using ::testing::HasSubstr;

std::string error_of(const std::vector<Override>& overrides) {
  const auto mission = load_mission_settings(overrides);
  return mission ? "no error" : mission.error().message;
}

TEST(MissionSettings, WithoutOverridesAreTheDefaults) {
  const auto mission = load_mission_settings({});
  ASSERT_TRUE(mission) << mission.error().message;
  const planning::MissionConfig usual;
  EXPECT_EQ(mission->speed, usual.speed);
  EXPECT_EQ(mission->division.method, usual.division.method);
  EXPECT_EQ(mission->rendezvous, usual.rendezvous);
}

TEST(MissionSettings, OverridesChangeThemAndTheLastOneHolds) {
  const auto mission =
      load_mission_settings({{"mission.speed", "1.2"}, {"mission.every", "3"}, {"mission.speed", "0.7"}});
  ASSERT_TRUE(mission) << mission.error().message;
  EXPECT_EQ(mission->speed, 0.7);
  EXPECT_EQ(mission->rows.every, 3);
}

TEST(MissionSettings, ProblemsNameTheOverride) {
  EXPECT_EQ(error_of({{"mission.evry", "3"}}), "--set mission.evry: unknown key; did you mean 'every'?");
  EXPECT_THAT(error_of({{"mission.every", "0"}}), HasSubstr("--set mission.every: must be at least 1"));
  EXPECT_THAT(error_of({{"mission.speed", "fast"}}),
              HasSubstr("--set mission.speed: expected a number, found 'fast'"));
  EXPECT_THAT(error_of({{"lidar.model", "vlp16"}}), HasSubstr("--set lidar.model: unknown key"));
  EXPECT_THAT(error_of({{"mission..speed", "1"}}), HasSubstr("the key must look like"));
}

}  // namespace
}  // namespace fleetmap::config
