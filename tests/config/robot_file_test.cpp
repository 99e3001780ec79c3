#include "fleetmap/config/robot_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config_files.hpp"

namespace fleetmap::config {
namespace {

using ::testing::AllOf;
using ::testing::Eq;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class RobotFileTest : public ConfigFiles {
 protected:
  RobotConfig sensors(const std::string& text, const std::vector<Override>& overrides = {}) {
    const auto robot = load_sensors(write(text), overrides);
    EXPECT_TRUE(robot) << robot.error().message;
    return robot.value_or(RobotConfig{});
  }
};

TEST_F(RobotFileTest, NameFleetAndFolderAreEnough) {
  const auto robot = load_robot(write(kRobot), {});
  ASSERT_TRUE(robot) << robot.error().message;
  EXPECT_EQ(robot->agent.id.str(), "r1");
  EXPECT_EQ(robot->dds.agent, robot->agent.id);
  EXPECT_EQ(robot->agent.exchange.fleet.size(), 2u);
  EXPECT_EQ(robot->agent.directory, folder_.path() / "out");
  EXPECT_TRUE(robot->dds.settings);
  EXPECT_FALSE(robot->recording);
  EXPECT_FALSE(robot->mission);
  EXPECT_EQ(robot->dds.keys, nullptr);
}

TEST_F(RobotFileTest, EachOfThemIsNeeded) {
  EXPECT_THAT(robot_error("fleet: [r1]\ndirectory: out\n"),
              HasSubstr("id: expected the robot's name, e.g. id: r1"));
  EXPECT_THAT(robot_error("id: r1\nfleet: [r1]\n"),
              HasSubstr("directory: expected the folder where the agent keeps its store and maps"));
  EXPECT_THAT(robot_error("id: r1\nfleet: [r2]\ndirectory: out\n"),
              HasSubstr("config.yaml:2: fleet: expected the names of all robots, this one ('r1') too"));
  EXPECT_THAT(robot_error("id: r 1\nfleet: [r1]\ndirectory: out\n"), HasSubstr("config.yaml:1: id: "));
  EXPECT_THAT(robot_error(kRobot + "robot: {}\n"), HasSubstr("robot: unknown key")) << "that is a twin's";
}

TEST_F(RobotFileTest, ARecordingAndTheRadiosAreRead) {
  const auto robot = load_robot(write(kRobot + "recording: {path: drive.mcap}\n"
                                               "dds: {long_range: {multicast: true, domain: 9}}\n"),
                                {});
  ASSERT_TRUE(robot) << robot.error().message;
  ASSERT_TRUE(robot->recording);
  EXPECT_EQ(robot->recording->path, folder_.path() / "drive.mcap");
  EXPECT_EQ(robot->dds.long_range.domain, 9u);
  EXPECT_TRUE(robot->agent.exchange.long_range.multicast) << "the budget counts one copy";
  EXPECT_DOUBLE_EQ(robot->dds.long_range.fleet_bits_per_second,
                   8.0 * robot->agent.exchange.long_range.fleet_bytes_per_second);
}

TEST_F(RobotFileTest, AnErrorOfAnOverrideNamesTheOverride) {
  const auto error_of = [&](const Override& one) {
    const auto robot = load_robot(write(kRobot + "dds: {onboard: {domain: 7}}\n"), {one});
    return robot ? std::string() : robot.error().message;
  };
  EXPECT_THAT(error_of({"nope.x", "1"}), StartsWith("--set nope.x: unknown key; known here: "));
  EXPECT_THAT(error_of({"lidr.model", "vlp16"}), Eq("--set lidr.model: unknown key; did you mean 'lidar'?"));
  EXPECT_THAT(error_of({"dds.onboard.domain", "900"}), StartsWith("--set dds.onboard.domain: "));
}

TEST_F(RobotFileTest, SensorsNeedNoFileAndNoName) {
  const auto usual = load_sensors(std::nullopt, {});
  ASSERT_TRUE(usual) << usual.error().message;
  EXPECT_FALSE(usual->recording);
  const auto set = load_sensors(std::nullopt, {{"lidar.model", "os1-64"}, {"recording.path", "drive.bag"}});
  ASSERT_TRUE(set) << set.error().message;
  EXPECT_EQ(set->agent.perception.lidar.name, "os1-64");
  EXPECT_NE(set->agent.perception.lidar.name, usual->agent.perception.lidar.name);
  EXPECT_EQ(set->recording->path, "drive.bag");
  const auto wrong = load_sensors(std::nullopt, {{"lidar.modle", "os1-64"}});
  ASSERT_FALSE(wrong);
  EXPECT_THAT(wrong.error().message, HasSubstr("--set lidar.modle: unknown key; did you mean 'model'?"));
}

TEST_F(RobotFileTest, SensorsOfAFleetAreThoseOfItsFirstAgent) {
  const std::string fleet =
      "defaults: {lidar: {model: hdl64e, min_range: 2, max_range: 30}}\n"
      "agents:\n  - {id: a, lidar: {max_range: 20, min_range: 3}}\n  - {id: b, lidar: {max_range: 10}}\n";
  const RobotConfig first = sensors(fleet);
  EXPECT_EQ(first.agent.id.str(), "a");
  EXPECT_EQ(first.agent.perception.lidar.name, "hdl64e");
  EXPECT_DOUBLE_EQ(first.agent.perception.odometry.max_range, 20.0);
  EXPECT_DOUBLE_EQ(first.agent.perception.odometry.min_range, 3.0);
  const RobotConfig all = sensors(fleet, {{"lidar.max_range", "15"}});
  EXPECT_DOUBLE_EQ(all.agent.perception.odometry.max_range, 15.0) << "--set goes to every agent";
  EXPECT_DOUBLE_EQ(all.agent.perception.odometry.min_range, 3.0);
}

TEST_F(RobotFileTest, SensorsOfARobotIgnoreItsMissionAndKeys) {
  const RobotConfig robot =
      sensors(kRobot + "lidar: {model: hdl64e}\nmission: {file: none.geojson}\nkeys: {folder: none}\n");
  EXPECT_EQ(robot.agent.perception.lidar.name, "hdl64e");
  const auto typo = load_sensors(write(kRobot + "lidr: {}\n"), {});
  ASSERT_FALSE(typo);
  EXPECT_THAT(
      typo.error().message,
      AllOf(HasSubstr("config.yaml:4: lidr: unknown key; did you mean 'lidar'?"), Not(HasSubstr("\n"))));
}

}  // namespace
}  // namespace fleetmap::config
