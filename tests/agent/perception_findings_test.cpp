// Faults of clocks, mounts and point times are findings of the robot, beside those of the samples.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "fleetmap/agent/perception.hpp"
#include "fleetmap/bus/local_network.hpp"
#include "fleetmap/ros_codec/frame_transforms.hpp"
#include "fleetmap/ros_codec/point_cloud2.hpp"
#include "fleetmap/ros_codec/samples.hpp"
#include "fleetmap/ros_codec/topics.hpp"
#include "support/robots.hpp"

namespace fleetmap::agent {
namespace {

using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A robot at rest whose sensors' stamps have an offset each.
class PerceptionFindings : public ::testing::Test {
 protected:
  void start() {
    bus::LocalNetworkConfig network;
    network.start = fleetmap::testing::kStart;
    network_ = bus::LocalNetwork::create(network).value();
    bus_ = &network_->add_robot(AgentId::parse("r1").value());
    perception_ = std::make_unique<Perception>(config_, *bus_, [](ScanEstimate&&) {});
  }
  void run_for(Duration time) {
    if (!perception_) start();
    for (const Stamp end = network_->now() + time; network_->now() < end;) {
      network_->run_until(network_->now() + 10ms);
      sensor::Imu imu;
      imu.stamp = network_->now() + imu_clock_;
      imu.specific_force.z() = 9.80665;
      bus_->publish(ros_codec::topics::imu(), ros_codec::encode(imu));
      sensor::Wheel wheel;
      wheel.stamp = network_->now();
      bus_->publish(ros_codec::topics::wheel_odometry(), ros_codec::encode(wheel));
      if ((network_->now() - fleetmap::testing::kStart) % 100ms == 0ms) scan();
    }
  }
  void scan() {
    sensor::Scan scan;
    scan.stamp = network_->now();
    scan.points.push_back({{1.0f, 2.0f, 3.0f}});
    bus_->publish(ros_codec::topics::points(), ros_codec::encode(scan, lidars_[scans_++ % lidars_.size()]));
  }
  const sensor::SensorHealth& health() const { return perception_->health(); }

  PerceptionConfig config_;
  Duration imu_clock_{};
  std::vector<std::string> lidars_{"velodyne"};  ///< frames, by turns
  std::size_t scans_ = 0;
  std::unique_ptr<bus::LocalNetwork> network_;
  bus::Bus* bus_ = nullptr;
  std::unique_ptr<Perception> perception_;
};

TEST_F(PerceptionFindings, ThereIsNoneOfSoundSensors) {
  run_for(20s);
  EXPECT_THAT(health().findings(), IsEmpty());
}

TEST_F(PerceptionFindings, AClockOfAnotherTimeScaleIsANote) {
  imu_clock_ = 37s;
  run_for(20s);
  ASSERT_THAT(health().findings(),
              ElementsAre(AllOf(HasSubstr("imu: stamps are 37.00 s ahead"), HasSubstr("TAI"))));
  EXPECT_EQ(health().notes(), health().findings());
  EXPECT_THAT(health().alarms(), IsEmpty());
}

TEST_F(PerceptionFindings, AClockThatIsCorrectedByAnEstimateIsAnAlarm) {
  imu_clock_ = -5s;
  run_for(20s);
  EXPECT_THAT(health().alarms(), ElementsAre(HasSubstr("imu: stamps are 5.00 s behind")));
  EXPECT_THAT(health().notes(), IsEmpty());
}

TEST_F(PerceptionFindings, AClockThatIsSetAgainAndAgainDoesNotFillThem) {
  for (int k = 1; k <= 40; ++k) {
    imu_clock_ = k % 2 == 0 ? 3s * k : -3s * k;
    run_for(12s);
  }
  EXPECT_GE(health().findings().size(), 10u);
  EXPECT_LE(health().findings().size(), 21u) << "20 of clocks, and the IMU's gaps";
}

TEST_F(PerceptionFindings, AnUnknownMountIsOne) {
  start();
  bus_->publish(ros_codec::topics::tf_static(),
                ros_codec::encode({{"base_link", "imu", {}, Eigen::Quaterniond::Identity()}}));
  run_for(1s);
  EXPECT_THAT(health().alarms(),
              ElementsAre(AllOf(HasSubstr("LiDAR (frame 'velodyne'): its mount is unknown"),
                                HasSubstr("it is taken to be at base_link"))));
}

TEST_F(PerceptionFindings, TwoLidarsOnOneTopicAreOne) {
  lidars_ = {"front", "rear"};
  run_for(2s);
  EXPECT_THAT(health().alarms(),
              ElementsAre(AllOf(HasSubstr("'front' and 'rear'"), HasSubstr("topics.points"))));
}

TEST_F(PerceptionFindings, ThoseOfTheRecordingComeFirst) {
  config_.findings_before = {"IMU (frame 'imu'): its mount is unknown"};
  run_for(1s);
  EXPECT_THAT(health().findings(), ElementsAre("IMU (frame 'imu'): its mount is unknown"));
}

}  // namespace
}  // namespace fleetmap::agent
