// Whole agents in virtual time whose sensors' clocks disagree or are set while they drive.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "agent/driven_fleet.hpp"
#include "faulty_file_system.hpp"

namespace fleetmap::agent {
namespace {

using namespace std::chrono_literals;
using testing::DrivenFleet;

/// A robot that drives, and where it truly was.
class SensorClocks : public ::testing::Test {
 protected:
  void run_for(Duration time) {
    for (const Stamp end = fleet_.now() + time; fleet_.now() < end;) {
      truth_[fleet_.now()] = robot().twin->T_enu_base().translation();
      fleet_.run_for(20ms);
    }
  }
  DrivenFleet::Robot& robot() { return fleet_.robot(); }
  const Perception& perception() { return robot().agent->perception(); }
  std::set<graph::FrameId> frames() {
    std::set<graph::FrameId> frames;
    for (const auto& [id, node] : robot().agent->store().nodes()) frames.insert(node.frame());
    return frames;
  }
  /// m, of the nodes made after `from`: how far the robot was, at a node's stamp, from where its odometry has
  /// the node, as seen from the first of these.
  double worst_displacement(Stamp from) {
    std::optional<graph::Node> first;
    Eigen::Vector3d true_first = Eigen::Vector3d::Zero();
    double worst = 0.0;
    int compared = 0;
    for (const auto& [id, node] : robot().agent->store().nodes()) {
      const auto true_now = truth_.lower_bound(node.stamp);
      if (node.stamp < from || true_now == truth_.end()) continue;
      if (!first) {
        first = node;
        true_first = true_now->second;
      }
      const double by_odometry = (node.T_odom_base.translation() - first->T_odom_base.translation()).norm();
      worst = std::max(worst, std::abs(by_odometry - (true_now->second - true_first).norm()));
      ++compared;
    }
    EXPECT_GE(compared, 2);
    return worst;
  }

  fault_injection::FaultyFileSystem disk_;
  DrivenFleet fleet_{{.file_system = disk_.name()}};
  std::map<Stamp, Eigen::Vector3d> truth_;
};

TEST_F(SensorClocks, ALidarThatIsBehindIsCorrected) {
  robot().lidar_clock = -2s;
  run_for(20s);
  EXPECT_NEAR(perception().clock_offsets().behind(sensor::Source::kLidar).value(), 2.0, 0.3);
  // The first node is made at rest; one whose stamp is off has another displacement once the robot moves.
  EXPECT_LT(worst_displacement({}), 0.4);
  EXPECT_EQ(perception().odometry_counters().map_restarts, 0u);
}

TEST_F(SensorClocks, ALidarOfGpsTimeIsCorrected) {
  robot().lidar_clock = 18s;
  run_for(20s);
  EXPECT_LT(worst_displacement({}), 0.4);
}

TEST_F(SensorClocks, ALidarThatJumpsBackWhileTheRobotDrivesGoesOn) {
  run_for(10s);
  ASSERT_GT(robot().twin->speed(), 0.5);
  robot().lidar_clock = -5s;
  run_for(12s);
  EXPECT_NEAR(to_seconds(perception().clock_offsets().correction(sensor::Source::kLidar)), 5.0, 0.3);
  EXPECT_EQ(frames().size(), 1u) << "nothing was lost";
  EXPECT_LT(worst_displacement({}), 0.4);
}

TEST_F(SensorClocks, AClockOfAllThatIsSetBackBeginsASession) {
  run_for(10s);
  ASSERT_GT(robot().twin->speed(), 0.5);
  robot().clock = -60s;
  run_for(12s);
  EXPECT_EQ(perception().clock_offsets().correction(sensor::Source::kLidar), Duration::zero());
  EXPECT_EQ(perception().odometry_counters().clock_resets, 1u);
  EXPECT_EQ(frames().size(), 2u);
}

/// Two odometry origins in one frame would bend the map, so no node is made until the session could be
/// stored.
TEST_F(SensorClocks, ASessionThatCannotBeStoredBeginsOnceTheDiskWrites) {
  run_for(10s);
  ASSERT_GT(robot().twin->speed(), 0.5);
  const store::Store& store = robot().agent->store();
  const auto nodes = store.nodes().size();
  ASSERT_GE(nodes, 2u);
  const graph::FrameId before = store.nodes().begin()->second.frame();
  disk_.set_full(true);
  robot().clock = -60s;
  run_for(8s);
  EXPECT_GT(perception().odometry_counters().clock_resets, 0u);
  EXPECT_EQ(store.nodes().size(), nodes);
  disk_.set_full(false);
  run_for(8s);
  ASSERT_EQ(frames().size(), 2u);
  const auto of_first_frame =
      std::ranges::count_if(store.nodes(), [&](const auto& entry) { return entry.second.frame() == before; });
  EXPECT_EQ(static_cast<std::size_t>(of_first_frame), nodes) << "none was added to the frame before";
  EXPECT_GT(store.nodes().size(), nodes) << "mapping goes on";
}

}  // namespace
}  // namespace fleetmap::agent
