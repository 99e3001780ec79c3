#include "page/fleet_state.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "agent/lapping_robot.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::HasSubstr;

TEST(FleetState, IsWhatTheAgentHasHeardAndWhatIsWrongWithIt) {
  const testing::TemporaryFolder folder;
  testing::LappingRobot::Options options;
  options.columns = 200;
  options.folder = folder.path() / "r1";
  testing::LappingRobot robot(options);
  robot.run_for(3.0);
  const agent::Agent& agent = robot.agent();
  EXPECT_THAT(problems_of(agent, robot.bus().now()), ::testing::IsEmpty());
  const Stamp later = robot.bus().now() + std::chrono::seconds(9);
  const FleetState fleet = fleet_state(agent, {}, later);
  EXPECT_EQ(fleet.self, agent.config().id);
  EXPECT_EQ(fleet.now, later);
  EXPECT_TRUE(fleet.statuses.contains(fleet.self));
  EXPECT_THAT(fleet.problems.at(fleet.self), ::testing::ElementsAre(HasSubstr("no scan for 9 s")));
}

TEST(FleetState, FindingsOfTheSensorsAreProblemsWithoutTheirRemedies) {
  const testing::TemporaryFolder folder;
  testing::LappingRobot::Options options;
  options.columns = 200;
  options.folder = folder.path() / "r1";
  options.clocks[static_cast<std::size_t>(sensor::Source::kImu)].ahead = -std::chrono::seconds(5);
  testing::LappingRobot robot(options);
  robot.run_for(20.0);
  EXPECT_THAT(
      problems_of(robot.agent(), robot.bus().now()),
      ::testing::Contains(::testing::MatchesRegex("imu: stamps are .* s behind those of the other sensors")));
}

}  // namespace
}  // namespace fleetmap::apps
