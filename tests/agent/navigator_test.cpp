#include "fleetmap/agent/navigator.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "fleetmap/bus/local_network.hpp"
#include "fleetmap/fleet_codec/messages.hpp"
#include "fleetmap/fleet_codec/topics.hpp"
#include "fleetmap/ros_codec/samples.hpp"
#include "fleetmap/ros_codec/topics.hpp"

namespace fleetmap::agent {
namespace {

/// Two rows of 20 m to the east for two robots on open ground.
std::shared_ptr<const planning::FleetPlan> small_plan() {
  planning::Mission mission;
  mission.rows = {{0, {{2.0, 0.0}, {22.0, 0.0}}}, {1, {{2.0, 8.0}, {22.0, 8.0}}}};
  std::vector<planning::RobotAbility> fleet(2);
  fleet[0].id = AgentId::parse("r1").value();
  fleet[1].id = AgentId::parse("r2").value();
  fleet[1].start.position = {0.0, 8.0};
  auto plan = planning::plan_fleet(mission, fleet, {});
  EXPECT_TRUE(plan) << plan.error().message;
  return plan ? *plan : nullptr;
}

class NavigatorTest : public ::testing::Test {
 protected:
  void SetUp() override {
    auto network = bus::LocalNetwork::create({});
    ASSERT_TRUE(network);
    network_ = std::move(*network);
    bus_ = &network_->add_robot(self_);
    subscription_ = bus_->subscribe(ros_codec::topics::cmd_vel(), [this](const Bytes& cdr) {
      commands_.push_back(ros_codec::decode<ros_codec::VelocityCommand>(cdr).value());
    });
    NavigatorConfig config;
    config.plan = small_plan();
    ASSERT_TRUE(config.plan);
    auto made = Navigator::create(config, self_, site_, *bus_, [this](messages::MissionReport report) {
      reports_.push_back(std::move(report));
    });
    ASSERT_TRUE(made) << made.error().message;
    navigator_ = std::move(*made);
  }

  /// A scan at `p` (ENU) with the robot's nose to `yaw`.
  ScanEstimate at(const Eigen::Vector2d& p, double yaw) const {
    ScanEstimate estimate;
    estimate.G.emplace();
    estimate.G->position = LocalFrame(site_).to_geo({p.x(), p.y(), 0.0});
    estimate.G->q_enu_base = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ());
    return estimate;
  }
  /// Scans and ticks at one place for `seconds`; `told`: what who leads the robot tells it.
  void stay(const ScanEstimate& estimate, int seconds, const Bytes& told = {}) {
    for (int k = 0; k < 10 * seconds; ++k) {
      if (!told.empty()) bus_->publish(fleet_codec::topics::guide_pose(), told);
      network_->run_until(network_->now() + std::chrono::milliseconds(100));
      see(estimate);
      if (k % 5 == 4) navigator_->tick(false);
    }
    network_->run_until(network_->now());
  }
  void see(ScanEstimate estimate) {
    estimate.arrival = network_->now();
    navigator_->on_scan();
    navigator_->on_estimate(estimate);
  }
  void expect_zeros() const {
    for (const auto& command : commands_) {
      ASSERT_EQ(command.forward_speed, 0.0);
      ASSERT_EQ(command.yaw_rate, 0.0);
    }
  }
  static messages::HoldOrder order(bool hold) {
    using Kind = messages::HoldOrder::Kind;
    return {{}, {}, AgentId::parse("operator").value(), hold ? Kind::kHold : Kind::kResume};
  }
  messages::MissionReport report_of(const char* id, Bytes done) const {
    messages::MissionReport report;
    report.from = AgentId::parse(id).value();
    report.stamp = network_->now() + std::chrono::seconds(1);
    report.current = messages::MissionReport::kNoRow;
    report.done = messages::RowSet(std::move(done));
    return report;
  }

  AgentId self_ = AgentId::parse("r1").value();
  GeoPoint site_ = geo_point_from_degrees(39.0, -3.0, 600.0);
  std::unique_ptr<bus::LocalNetwork> network_;
  bus::Bus* bus_ = nullptr;
  bus::Handle subscription_;
  std::vector<ros_codec::VelocityCommand> commands_;
  std::vector<messages::MissionReport> reports_;
  std::unique_ptr<Navigator> navigator_;
};

TEST_F(NavigatorTest, DrivesAlongItsRow) {
  stay(at({0.0, 0.0}, 0.0), 2);
  ASSERT_FALSE(commands_.empty());
  EXPECT_GT(commands_.back().forward_speed, 0.2) << "the row lies ahead";
  EXPECT_NEAR(commands_.back().yaw_rate, 0.0, 0.3);
}

TEST_F(NavigatorTest, TurnsTowardsItsRow) {
  stay(at({0.0, 0.0}, -1.57), 2);
  ASSERT_FALSE(commands_.empty());
  EXPECT_GT(commands_.back().yaw_rate, 0.2) << "the row lies to the left";
  commands_.clear();
  stay(at({0.0, 0.0}, 1.57), 2);
  EXPECT_LT(commands_.back().yaw_rate, -0.2) << "the row lies to the right";
}

TEST_F(NavigatorTest, StandsStillWithoutAPose) {
  stay({}, 3);
  ASSERT_FALSE(commands_.empty()) << "it says so";
  stay(at({0.0, 0.0}, 0.0), 2);
  commands_.clear();
  stay({}, 1);
  ASSERT_FALSE(commands_.empty());
  for (const auto& command : commands_) {
    EXPECT_EQ(command.forward_speed, 0.0) << "the pose was lost on the way";
    EXPECT_EQ(command.yaw_rate, 0.0);
  }
}

TEST_F(NavigatorTest, WithoutGpsItIsLedByWhoKnowsWhereItIs) {
  const auto led_at = [&](const Eigen::Vector2d& p) {
    GlobalPose pose = *at(p, 0.0).G;
    pose.stamp = network_->now();
    stay({}, 1, fleet_codec::encode(pose));
  };
  for (int k = 0; k < 3; ++k) led_at({0.0, 0.0});
  EXPECT_GT(commands_.back().forward_speed, 0.2) << "the row lies ahead";
  ASSERT_FALSE(reports_.empty());
  EXPECT_NEAR(reports_.back().position.x(), 0.0, 0.01);

  stay(at({30.0, 30.0}, 0.0), 1);
  bus_->publish(fleet_codec::topics::guide_pose(), Bytes(7, 0xff));
  GlobalPose nowhere = *at({0.0, 0.0}, 0.0).G;
  nowhere.position.latitude = std::numeric_limits<double>::quiet_NaN();
  bus_->publish(fleet_codec::topics::guide_pose(), fleet_codec::encode(nowhere));
  stay({}, 1);
  commands_.clear();
  stay({}, 2);
  ASSERT_FALSE(commands_.empty());
  for (const auto& command : commands_) EXPECT_EQ(command.forward_speed, 0.0) << "who led it fell silent";
}

TEST_F(NavigatorTest, GuidePoseReplacesGps) {
  for (int k = 0; k < 8; ++k) {
    stay(at({9.0, 4.0}, 0.0), 1, fleet_codec::encode(*at({1.0, 0.0}, 0.0).G));
  }
  ASSERT_FALSE(reports_.empty());
  EXPECT_NEAR(reports_.back().position.x(), 1.0, 0.01);
  stay(at({9.0, 4.0}, 0.0), 8);
  EXPECT_NEAR(reports_.back().position.x(), 9.0, 0.01) << "alone again, it goes by its own G";
}

TEST_F(NavigatorTest, APoseThatIsNotFiniteIsNone) {
  ScanEstimate broken = at({0.0, 0.0}, 0.0);
  broken.G->position.latitude = std::numeric_limits<double>::quiet_NaN();
  stay(broken, 2);
  for (const auto& command : commands_) EXPECT_EQ(command.forward_speed, 0.0);
  EXPECT_TRUE(reports_.empty());
}

TEST_F(NavigatorTest, StopsInFrontOfAWall) {
  ScanEstimate estimate = at({0.0, 0.0}, 0.0);
  for (float y = -8.0f; y <= 8.0f; y += 0.05f) {
    for (float z = 0.2f; z < 1.0f; z += 0.1f) estimate.odometry.points.points.emplace_back(0.55f, y, z);
  }
  stay(estimate, 3);
  ASSERT_FALSE(commands_.empty());
  for (const auto& command : commands_) EXPECT_LE(command.forward_speed, 0.11);
}

TEST_F(NavigatorTest, TellsTheOthersEveryFewSeconds) {
  stay({}, 6);
  EXPECT_TRUE(reports_.empty()) << "there is nothing to tell without a pose";
  stay(at({0.0, 0.0}, 0.0), 16);
  ASSERT_GE(reports_.size(), 3u);
  EXPECT_LE(reports_.size(), 4u);
  EXPECT_EQ(reports_.back().from, self_);
  EXPECT_NEAR(reports_.back().position.x(), 0.0, 0.01);
  EXPECT_EQ(reports_.back().claimed.bytes().size(), 1u);
  EXPECT_TRUE(reports_.back().claimed.has(0)) << "it claims its row";
}

TEST_F(NavigatorTest, HearsOfItsBattery) {
  EXPECT_FALSE(navigator_->battery());
  bus_->publish(ros_codec::topics::battery(), ros_codec::encode(sensor::Battery{network_->now(), 0.25}));
  network_->run_until(network_->now());
  ASSERT_TRUE(navigator_->battery());
  EXPECT_NEAR(*navigator_->battery(), 0.25, 1e-6);
  stay(at({0.0, 0.0}, 0.0), 2);
  ASSERT_FALSE(reports_.empty());
  EXPECT_NEAR(reports_.back().battery, 0.25, 1e-6);
}

TEST_F(NavigatorTest, RowsThatOthersDroveAreDrivenIfTheirNodesLieAlongThem) {
  stay(at({0.0, 0.0}, 0.0), 2);
  EXPECT_FALSE(navigator_->all_rows_driven());
  navigator_->on_report(report_of("r2", {0b11}));
  stay(at({0.0, 0.0}, 0.0), 2);
  EXPECT_FALSE(navigator_->all_rows_driven()) << "one of the two is this robot's, and no node lies along it";
  for (double east = 2.0; east <= 22.0; east += 4.0) {
    graph::Node node;
    node.G.emplace();
    node.G->position = LocalFrame(site_).to_geo({east, 0.0, 0.0});
    navigator_->on_node(node);
  }
  stay(at({0.0, 0.0}, 0.0), 2);
  EXPECT_TRUE(navigator_->all_rows_driven());
}

TEST_F(NavigatorTest, ReportsThatCannotBeAreHarmless) {
  stay(at({0.0, 0.0}, 0.0), 2);
  const auto before = navigator_->status();
  messages::MissionReport beyond = report_of("r2", Bytes(128, 0xfc));
  beyond.claimed = beyond.failed = beyond.done;
  beyond.current = 900;
  beyond.state = static_cast<messages::MissionState>(250);
  beyond.position.x() = std::numeric_limits<double>::quiet_NaN();
  navigator_->on_report(beyond);
  navigator_->on_report(report_of("r9", {0b11}));
  navigator_->on_report(report_of("r1", {0b11}));
  stay(at({0.0, 0.0}, 0.0), 8);
  EXPECT_EQ(navigator_->status().rows, before.rows);
  EXPECT_EQ(navigator_->status().done, 0u) << "rows beyond the mission, a stranger's and its own word";
  EXPECT_GT(commands_.back().forward_speed, 0.2);
}

TEST_F(NavigatorTest, OnceStoppedItStandsForGood) {
  stay(at({0.0, 0.0}, 0.0), 2);
  commands_.clear();
  navigator_->stop();
  stay(at({0.0, 0.0}, 0.0), 2);
  ASSERT_FALSE(commands_.empty());
  expect_zeros();
  EXPECT_EQ(navigator_->stop_reason(), StopReason::kStopping);
}

TEST_F(NavigatorTest, RepeatsZeroWhileItHasToStand) {
  stay(at({0.0, 0.0}, 0.0), 2);
  network_->run_until(network_->now() + std::chrono::milliseconds(300));
  EXPECT_EQ(navigator_->stop_reason(), StopReason::kNoScan);
  commands_.clear();
  network_->run_until(network_->now() + std::chrono::seconds(1));
  EXPECT_GE(commands_.size(), 45u) << "whoever lost one gets the next";
  expect_zeros();
}

TEST_F(NavigatorTest, StandsAsSoonAsGIsTooUncertain) {
  stay(at({0.0, 0.0}, 0.0), 2);
  ScanEstimate uncertain = at({0.0, 0.0}, 0.0);
  uncertain.G->covariance = 4.9 * 4.9 * Matrix6d::Identity();
  commands_.clear();
  stay(uncertain, 1);
  EXPECT_GT(commands_.back().forward_speed, 0.2) << "it still knows its lane";
  uncertain.G->covariance = 5.1 * 5.1 * Matrix6d::Identity();
  commands_.clear();
  stay(uncertain, 1);
  expect_zeros();
  EXPECT_EQ(navigator_->stop_reason(), StopReason::kNoPose);
  uncertain.G->covariance = Matrix6d::Constant(std::numeric_limits<double>::quiet_NaN());
  stay(uncertain, 1);
  EXPECT_EQ(navigator_->stop_reason(), StopReason::kNoPose);
  stay(at({0.0, 0.0}, 0.0), 1);
  EXPECT_GT(commands_.back().forward_speed, 0.2);
}

TEST_F(NavigatorTest, StandsAsSoonAsTheOdometryIsLost) {
  stay(at({0.0, 0.0}, 0.0), 2);
  ScanEstimate lost = at({0.0, 0.0}, 0.0);
  lost.odometry.lost = true;
  commands_.clear();
  stay(lost, 1);
  ASSERT_FALSE(commands_.empty());
  expect_zeros();
  EXPECT_EQ(navigator_->stop_reason(), StopReason::kNoOdometry);
  commands_.clear();
  stay(lost, 1, fleet_codec::encode(*at({0.0, 0.0}, 0.0).G));
  expect_zeros();  // whoever leads it does not see what is in the way
}

TEST_F(NavigatorTest, GuidedRobotObeysAnOrder) {
  const Bytes told = fleet_codec::encode(*at({0.0, 0.0}, 0.0).G);
  stay({}, 2, told);
  EXPECT_GT(commands_.back().forward_speed, 0.2);
  navigator_->obey(order(true));
  network_->run_until(network_->now());
  commands_.clear();
  stay({}, 2, told);
  expect_zeros();
}

TEST_F(NavigatorTest, HeldRobotIsNotStuckAndKeepsItsRow) {
  stay(at({0.0, 0.0}, 0.0), 2);
  ASSERT_EQ(navigator_->status().mine, 1u);
  navigator_->obey(order(true));
  network_->run_until(network_->now());
  commands_.clear();
  stay(at({0.0, 0.0}, 0.0), 50);
  expect_zeros();
  EXPECT_EQ(navigator_->status().state, messages::MissionState::kDriving);
  EXPECT_EQ(navigator_->status().mine, 1u);
  EXPECT_EQ(navigator_->status().replans, 0u);
  EXPECT_FALSE(reports_.empty()) << "the others hear of it";
  navigator_->obey(order(false));
  stay(at({0.0, 0.0}, 0.0), 5);
  EXPECT_GT(commands_.back().forward_speed, 0.2);
  EXPECT_EQ(navigator_->status().mine, 1u) << "the time that it was held does not count";
}

TEST_F(NavigatorTest, RobotThatIsBlindForLongGivesItsRowsToOthers) {
  stay(at({0.0, 0.0}, 0.0), 2);
  ASSERT_EQ(navigator_->status().mine, 1u);
  for (int k = 0; k < 60; ++k) {
    network_->run_until(network_->now() + std::chrono::milliseconds(500));
    navigator_->tick(false);
  }
  EXPECT_EQ(navigator_->status().mine, 0u);
}

TEST_F(NavigatorTest, RobotThatIsNotInThePlanHasNoNavigator) {
  NavigatorConfig config;
  config.plan = small_plan();
  const auto none = Navigator::create(config, AgentId::parse("r7").value(), site_, *bus_, [](auto) {});
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("r7"), std::string::npos) << none.error().message;
}

}  // namespace
}  // namespace fleetmap::agent
