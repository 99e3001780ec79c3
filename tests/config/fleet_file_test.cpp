#include "fleetmap/config/fleet_file.hpp"

#include <gmock/gmock.h>

#include "config_files.hpp"
#include "fleetmap/config/file_kind.hpp"

namespace fleetmap::config {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;

class FleetFileTest : public ConfigFiles {};

TEST_F(FleetFileTest, DefaultsReachEveryAgentAndAgentsMayDiffer) {
  const auto fleet = load_fleet(write(R"(
defaults:
  lidar: {model: hdl64e, max_range: 30}
  recording: {path: data/drive}
agents:
  - id: a
    recording: {frames: [0, 95]}
  - id: b
    lidar: {max_range: 20}
    recording: {frames: [60, 153], start: 2.5}
)"),
                                {{"nodes.spacing", "4"}});
  ASSERT_TRUE(fleet) << fleet.error().message;
  ASSERT_EQ(fleet->members.size(), 2u);
  const auto& a = fleet->members[0];
  const auto& b = fleet->members[1];
  EXPECT_EQ(a.agent.perception.lidar.name, "hdl64e");
  EXPECT_DOUBLE_EQ(a.agent.perception.odometry.max_range, 30.0);
  EXPECT_DOUBLE_EQ(b.agent.perception.odometry.max_range, 20.0);
  EXPECT_EQ(a.recording->path, folder_.path() / "data/drive") << "relative to the file";
  EXPECT_EQ(a.recording->reader.kitti.last_frame, 95u);
  EXPECT_EQ(b.recording->reader.kitti.first_frame, 60u);
  EXPECT_EQ(b.recording->start, 2.5);
  EXPECT_EQ(a.recording->start, std::nullopt);
  EXPECT_EQ(a.agent.exchange.fleet.size(), 2u);
  EXPECT_DOUBLE_EQ(a.agent.nodes.spacing, 4.0) << "--set goes to every agent";
  EXPECT_DOUBLE_EQ(b.agent.nodes.spacing, 4.0);
}

TEST_F(FleetFileTest, FleetProblemsAreNamed) {
  EXPECT_THAT(fleet_error("network: {}\n"), HasSubstr("agents: expected a list"));
  EXPECT_THAT(fleet_error("agents:\n  - {id: a, recording: {path: x}}\n  - {id: a, recording: {path: y}}\n"),
              HasSubstr("agents[1].id: 'a' is taken"));
  EXPECT_THAT(fleet_error("agents:\n  - {id: a}\n"),
              HasSubstr("config.yaml:2: agents[0].recording: expected"));
  EXPECT_THAT(fleet_error("agents:\n  - {id: a, recording: {path: x, frames: [9, 3]}}\n"),
              HasSubstr("agents[0].recording.frames: expected [first, last]"));
}

TEST_F(FleetFileTest, WhatEveryAgentGetsIsReportedOnceAndWhereItStands) {
  const std::string agents =
      "agents:\n  - {id: a, recording: {path: x}, lidar: {min_range: 1}}\n"
      "  - {id: b, recording: {path: y}}\n";
  EXPECT_THAT(fleet_error(agents + "max_tme: 900\n"),
              EndsWith("/config.yaml:4: max_tme: unknown key; did you mean 'max_time'?"));
  EXPECT_THAT(
      fleet_error(agents + "defaults:\n  lidar: {max_range: -40}\n  nodes: {spcing: 3}\n"),
      AllOf(HasSubstr("config.yaml:5: defaults.lidar.max_range: must be"),
            HasSubstr("config.yaml:6: defaults.nodes.spcing: unknown key"), Not(HasSubstr("agents["))));
  EXPECT_THAT(fleet_error(agents + "nodes: {spacing: far}\n"),
              EndsWith("/config.yaml:4: nodes.spacing: expected a number, found 'far'"));
  EXPECT_EQ(fleet_error(agents, {{"lidar.hight", "1"}, {"robot.lidar_rate", "-4", "e.yaml:7: axes[0]"}})
                .find("--set lidar.hight: unknown key"),
            0u);
  EXPECT_EQ(fleet_error(agents, {{"robot.lidar_rate", "-4", "e.yaml:7: axes[0]"}}),
            "e.yaml:7: axes[0]: robot.lidar_rate: expected 0.1 to 100 Hz");
}

TEST_F(FleetFileTest, FleetOfRecordingsNeedsNoFile) {
  const auto fleet = fleet_of({{AgentId::parse("r1").value(), "one"}, {AgentId::parse("r2").value(), "two"}},
                              {{"lidar.max_range", "25"}});
  ASSERT_TRUE(fleet) << fleet.error().message;
  ASSERT_EQ(fleet->members.size(), 2u);
  EXPECT_EQ(fleet->members[1].recording->path, "two");
  EXPECT_EQ(fleet->members[0].agent.perception.lidar.name, "vlp16");
  EXPECT_DOUBLE_EQ(fleet->members[0].agent.perception.odometry.max_range, 25.0);
}

TEST_F(FleetFileTest, RadiosOfTheNetworkCanBeSetAndSilenced) {
  const auto fleet = load_fleet(
      write("network:\n  short_range: {rate_kbit_s: 6000, delay: 0.01, loss: 0.1, max_range: 45}\n"
            "  blackouts: [{link: long_range, from: 5, until: 7.5}, {from: 0, until: 1, agent: r1}]\n"
            "agents: [{id: r1, recording: {path: x}}]\n"),
      {});
  ASSERT_TRUE(fleet) << fleet.error().message;
  EXPECT_EQ(fleet->network.short_range.rate_bit_s, 6e6);
  EXPECT_EQ(fleet->network.short_range.delay, std::chrono::milliseconds(10));
  EXPECT_EQ(fleet->network.short_range.loss, 0.1);
  EXPECT_EQ(fleet->network.short_range.max_range, 45.0);
  ASSERT_EQ(fleet->blackouts.size(), 2u);
  EXPECT_EQ(fleet->blackouts[0].link, bus::Link::kLongRange);
  EXPECT_EQ(fleet->blackouts[0].until, 7.5);
  EXPECT_FALSE(fleet->blackouts[0].agent);
  EXPECT_EQ(fleet->blackouts[1].link, bus::Link::kShortRange);
  EXPECT_EQ(fleet->blackouts[1].agent->str(), "r1");
  EXPECT_THAT(fleet_error("agents: [{id: r1, recording: {path: x}, robot: {switched_off: [{from: 1}]}}]\n"),
              HasSubstr("switched_off is for the twin"));
}

TEST(ShippedConfigurations, AreAllValid) {
  std::size_t files = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(std::filesystem::path(FLEETMAP_SOURCE_DIR) / "config")) {
    if (entry.path().extension() != ".yaml") continue;
    ++files;
    const auto kind = check(entry.path(), {});
    EXPECT_TRUE(kind) << kind.error().message;
  }
  EXPECT_GE(files, 2u);
}

TEST(ShippedConfigurations, OfATwinsFleetTheSensorsOfTheFirstRobotServeForItsRecordings) {
  const std::filesystem::path config = std::filesystem::path(FLEETMAP_SOURCE_DIR) / "config";
  const auto robot = load_sensors(config / "fleets" / "farm.yaml", {{"robot.lidar_rate", "5"}});
  ASSERT_TRUE(robot) << robot.error().message;
  EXPECT_NEAR(robot->agent.perception.lidar.scan_period, 0.2, 1e-9);
  EXPECT_NEAR(robot->agent.perception.odometry.T_base_lidar.translation().z(), 0.6, 1e-9);
}

}  // namespace
}  // namespace fleetmap::config
