#include "fleetmap/agent/perception.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "fleetmap/bus/local_network.hpp"
#include "fleetmap/fleet_codec/messages.hpp"
#include "fleetmap/fleet_codec/topics.hpp"
#include "fleetmap/ros_codec/frame_transforms.hpp"
#include "fleetmap/ros_codec/point_cloud2.hpp"
#include "fleetmap/ros_codec/samples.hpp"
#include "fleetmap/ros_codec/topics.hpp"
#include "support/robots.hpp"
#include "support/synthetic_lidar.hpp"

namespace fleetmap::agent {
namespace {

using fleetmap::testing::kStart;
using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
namespace topics = ros_codec::topics;

const Bytes kNoMessage(40, 7);

/// A scan at rest in a yard.
const sensor::Scan& yard_scan() {
  static const sensor::Scan scan = [] {
    testing::ScanOptions options;
    options.keep = 0.3;
    return testing::make_scan(
        testing::yard_world(), [](double) { return Pose::Identity(); }, 0.0, odometry::vlp16(), options);
  }();
  return scan;
}

class PerceptionTest : public ::testing::Test {
 protected:
  PerceptionTest() {
    config_.waiting_scans = 2;
    config_.odometry.T_base_lidar = testing::ScanOptions{}.T_base_lidar;
  }
  void SetUp() override {
    bus::LocalNetworkConfig network;
    network.start = kStart;
    network.perception_time = 50ms;
    network_ = bus::LocalNetwork::create(network).value();
    bus_ = &network_->add_robot(AgentId::parse("r1").value());
    perception_ = std::make_unique<Perception>(
        config_, *bus_, [this](ScanEstimate&& perceived) { perceived_.push_back(std::move(perceived)); },
        [this] { ++scans_heard_; });
  }
  void run_for(Duration time) { network_->run_until(network_->now() + time); }
  /// A scan whose first point was fired just now.
  void scan() {
    sensor::Scan scan = yard_scan();
    scan.stamp = network_->now();
    bus_->publish(topics::points(), ros_codec::encode(scan));
  }
  void imu(const Eigen::Matrix3d& R_enu_base, bool oriented) {
    sensor::Imu imu;
    imu.stamp = network_->now();
    imu.specific_force = 9.80665 * R_enu_base.row(2).transpose();
    if (oriented) imu.q_enu_imu = Eigen::Quaterniond(R_enu_base);
    imu.orientation_variance.setConstant(1e-4);
    bus_->publish(topics::imu(), ros_codec::encode(imu));
  }

  PerceptionConfig config_;
  std::unique_ptr<bus::LocalNetwork> network_;
  bus::Bus* bus_ = nullptr;
  std::vector<ScanEstimate> perceived_;
  int scans_heard_ = 0;
  std::unique_ptr<Perception> perception_;
};

TEST_F(PerceptionTest, AScanBecomesOdometryHereAndOnTheBus) {
  std::vector<ros_codec::OdometryMsg> told;
  const bus::Handle handle = bus_->subscribe(topics::odometry(), [&](const Bytes& cdr) {
    told.push_back(ros_codec::decode<ros_codec::OdometryMsg>(cdr).value());
  });
  EXPECT_EQ(perception_->last_scan(), kStart);
  run_for(1s);
  scan();
  run_for(10ms);
  EXPECT_EQ(scans_heard_, 1);
  EXPECT_FALSE(perception_->idle()) << "LOAM takes 50 ms";
  EXPECT_TRUE(perceived_.empty());
  run_for(1s);
  ASSERT_EQ(perceived_.size(), 1u);
  EXPECT_TRUE(perception_->idle());
  EXPECT_EQ(perceived_[0].odometry.stamp, kStart + 1s);
  EXPECT_EQ(perceived_[0].arrival, kStart + 1s);
  EXPECT_TRUE(perceived_[0].odometry.T_odom_base.isApprox(Pose::Identity()));
  EXPECT_FALSE(perceived_[0].G) << "there was no fix";
  EXPECT_FALSE(perceived_[0].up_is_measured);
  EXPECT_LT((perceived_[0].up_in_base - Eigen::Vector3d::UnitZ()).norm(), 1e-9);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].stamp, kStart + 1s);
  EXPECT_EQ(perception_->last_scan(), kStart + 1s);
  EXPECT_EQ(perception_->counters().scans, 1u);
  EXPECT_EQ(perception_->odometry_counters().updates, 1u);
}

TEST_F(PerceptionTest, UndecodableMessagesAreCountedAndSkipped) {
  run_for(1s);
  for (const bus::Topic& topic : {topics::imu(), topics::fix(), topics::wheel_odometry()})
    bus_->publish(topic, kNoMessage);
  bus_->publish(topics::points(), kNoMessage);
  run_for(1s);
  EXPECT_EQ(perception_->counters().refused_messages, 3u);
  EXPECT_EQ(perception_->counters().imu + perception_->counters().fixes + perception_->counters().wheel, 0u);
  EXPECT_EQ(perception_->counters().refused_scans, 1u);
  EXPECT_EQ(perception_->last_sample(), kStart + 1s) << "the driver is there, whatever it sends";
  EXPECT_TRUE(perceived_.empty());
  scan();
  run_for(1s);
  EXPECT_EQ(perceived_.size(), 1u);
}

/// A robot that turns on the spot by 2 rad; the points' y axis is multiplied by `mirror`.
std::vector<std::string> findings_of_a_turn(const PerceptionConfig& config, float mirror) {
  bus::LocalNetworkConfig network_config;
  network_config.start = kStart;
  network_config.perception_time = 50ms;
  const auto network = bus::LocalNetwork::create(network_config).value();
  bus::Bus& bus = network->add_robot(AgentId::parse("r1").value());
  Perception perception(config, bus, [](ScanEstimate&&) {});
  const testing::SyntheticDrive drive({{4.0, 0.0, 0.6}});
  const auto world = testing::yard_world();
  testing::ScanOptions options;
  options.keep = 0.3;
  for (int tick = 0; tick < 400; ++tick) {
    const double t = 0.01 * tick;
    network->run_until(kStart + from_seconds(t));
    sensor::Imu imu = drive.imu(t);
    imu.stamp = network->now();
    bus.publish(topics::imu(), ros_codec::encode(imu));
    sensor::Wheel wheel = drive.wheel(t);
    wheel.stamp = network->now();
    bus.publish(topics::wheel_odometry(), ros_codec::encode(wheel));
    if (tick % 10 != 0 || tick == 0) continue;
    sensor::Scan scan = testing::make_scan(
        world, [&](double at) { return drive.at(at); }, t - 0.1, odometry::vlp16(), options);
    scan.stamp = network->now() - 100ms;
    for (sensor::ScanPoint& point : scan.points) point.position.y() *= mirror;
    bus.publish(topics::points(), ros_codec::encode(scan));
  }
  network->run_until(network->now() + 1s);
  return perception.health().findings();
}

TEST_F(PerceptionTest, AMirroredLidarIsNamedInTheFirstTurnAndASoundOneIsNot) {
  EXPECT_THAT(findings_of_a_turn(config_, 1.0f), IsEmpty());
  EXPECT_THAT(findings_of_a_turn(config_, -1.0f),
              ElementsAre(HasSubstr("LiDAR: it turns right where gyro and wheels turn left: its points are "
                                    "mirrored")));
}

TEST_F(PerceptionTest, ScansBeyondThoseThatMayWaitTakeThePlaceOfTheOldest) {
  for (int k = 0; k < 5; ++k) bus_->publish(topics::points(), kNoMessage);
  run_for(10ms);
  EXPECT_EQ(scans_heard_, 5);
  EXPECT_EQ(perception_->counters().scans, 5u);
  EXPECT_EQ(perception_->counters().dropped_scans, 2u) << "one is under way, two wait";
  run_for(130ms);
  EXPECT_EQ(perception_->counters().refused_scans, 2u) << "one after the other, 50 ms each";
  run_for(1s);
  EXPECT_EQ(perception_->counters().refused_scans, 3u);
  EXPECT_TRUE(perception_->idle());
}

TEST_F(PerceptionTest, AfterStopNothingIsHeardAndNothingWaits) {
  for (int k = 0; k < 3; ++k) bus_->publish(topics::points(), kNoMessage);
  run_for(10ms);
  perception_->stop();
  EXPECT_FALSE(perception_->idle()) << "one is under way";
  bus_->publish(topics::points(), kNoMessage);
  run_for(1s);
  EXPECT_TRUE(perception_->idle());
  EXPECT_EQ(perception_->counters().scans, 3u);
  EXPECT_EQ(perception_->counters().refused_scans, 1u);
}

TEST_F(PerceptionTest, UpIsWhereTheImuSaysThatItIs) {
  const Eigen::Matrix3d R = rotation_from_rpy(0.1, -0.15, 0.0);
  for (int k = 0; k < 100; ++k) {
    imu(R, false);
    run_for(10ms);
  }
  scan();
  run_for(1s);
  ASSERT_EQ(perceived_.size(), 1u);
  EXPECT_TRUE(perceived_[0].up_is_measured);
  EXPECT_LT((perceived_[0].up_in_base - R.row(2).transpose()).norm(), 0.01);
  EXPECT_EQ(perception_->counters().imu, 100u);
}

TEST_F(PerceptionTest, WithFixesAndAHeadingThereIsAGlobalPoseOfTheScansInstant) {
  std::vector<GlobalPose> told;
  const bus::Handle handle = bus_->subscribe(fleet_codec::topics::global_pose(), [&](const Bytes& cdr) {
    told.push_back(fleet_codec::decode<GlobalPose>(cdr).value());
  });
  const GeoPoint place = geo_point_from_degrees(49.0, 8.4, 110.0);
  const Eigen::Matrix3d R = rotation_from_rpy(0.0, 0.0, 0.7);
  for (int k = 0; k < 300; ++k) {
    imu(R, true);
    if (k % 20 == 0) {
      sensor::Fix fix;
      fix.stamp = network_->now();
      fix.position = place;
      fix.covariance = Eigen::Matrix3d::Identity();
      bus_->publish(topics::fix(), ros_codec::encode(fix));
    }
    run_for(10ms);
  }
  EXPECT_TRUE(perception_->global_pose());
  const Stamp now = network_->now();
  scan();
  run_for(1s);
  ASSERT_EQ(perceived_.size(), 1u);
  ASSERT_TRUE(perceived_[0].G);
  EXPECT_EQ(perceived_[0].G->stamp, now);
  EXPECT_LT(LocalFrame(place).to_enu(perceived_[0].G->position).norm(), 0.5);
  EXPECT_NEAR(rpy_from_rotation(perceived_[0].G->q_enu_base.toRotationMatrix()).z(), 0.7, 0.05);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].stamp, now);
  EXPECT_EQ(perception_->counters().fixes, 15u);
}

/// A robot whose driver names its topic otherwise.
class RenamedTopic : public PerceptionTest {
 protected:
  RenamedTopic() { config_.topics.points = "rt/velodyne_points"; }
};

TEST_F(RenamedTopic, IsHeardAndOursIsNot) {
  scan();
  run_for(10ms);
  EXPECT_EQ(perception_->counters().scans, 0u);
  bus::Topic topic = topics::points();
  topic.name = "rt/velodyne_points";
  bus_->publish(topic, kNoMessage);
  run_for(10ms);
  EXPECT_EQ(perception_->counters().scans, 1u);
}

/// A robot whose LiDAR's driver publishes Livox's own message.
class LivoxDriver : public PerceptionTest {
 protected:
  LivoxDriver() { config_.topics.points_type = ros_codec::PointsType::kLivoxDriver2; }
};

TEST_F(LivoxDriver, ItsScansAreUsed) {
  bus::Topic topic = topics::points();
  topic.type = ros_codec::dds_name(ros_codec::PointsType::kLivoxDriver2);
  sensor::Scan scan = yard_scan();
  scan.stamp = network_->now();
  bus_->publish(topic, ros_codec::encode_points(scan, ros_codec::PointsType::kLivoxDriver2));
  run_for(500ms);
  EXPECT_EQ(perception_->counters().refused_scans, 0u);
  ASSERT_EQ(perceived_.size(), 1u);
  EXPECT_GT(perceived_[0].odometry.points.points.size(), 1000u);
}

/// A robot whose configuration leaves the mounts away.
class FramedSensors : public PerceptionTest {
 protected:
  FramedSensors() {
    config_.odometry.T_base_lidar = Pose::Identity();
    config_.frame_patience = 2s;
  }
  /// Publishes a scan of a LiDAR that is pitched by 20 deg.
  void pitched_scan() {
    sensor::Scan scan = yard_scan();
    scan.stamp = network_->now();
    const Eigen::Matrix3f R = kPitched.inverse().toRotationMatrix().cast<float>();
    for (auto& point : scan.points) point.position = R * point.position;
    bus_->publish(topics::points(), ros_codec::encode(scan, "velodyne"));
  }
  float lowest_point() const {
    float lowest = 0.0f;
    for (const auto& point : perceived_.back().odometry.points.points) lowest = std::min(lowest, point.z());
    return lowest;
  }

  const Eigen::Quaterniond kPitched{rotation_from_rpy(0.0, 0.35, 0.0)};
  const std::vector<sensor::FrameTransform> kFrames{{"base_link", "velodyne", {0.0, 0.0, 0.8}, kPitched},
                                                    {"base_link", "imu", {}, kPitched}};
};

TEST_F(FramedSensors, WaitForTheirMountsAndUseThem) {
  bus_->publish(topics::points(), kNoMessage);  // decides nothing
  run_for(1s);
  pitched_scan();
  run_for(500ms);
  EXPECT_EQ(perception_->counters().waited_for_frames, 1u);
  EXPECT_TRUE(perceived_.empty());
  bus_->publish(topics::tf_static(), ros_codec::encode(kFrames));
  run_for(10ms);
  pitched_scan();
  run_for(500ms);
  ASSERT_EQ(perceived_.size(), 1u);
  EXPECT_TRUE(perception_->T_base_lidar().isApprox(make_pose(kPitched, {0.0, 0.0, 0.8}), 1e-9));
  EXPECT_GT(lowest_point(), -0.3f) << "the ground is level";
  // The IMU is known later than the first scan was used.
  for (int k = 0; k < 50; ++k) {
    sensor::Imu imu;
    imu.stamp = network_->now();
    imu.specific_force = kPitched.inverse() * Eigen::Vector3d(0.0, 0.0, 9.80665);
    bus_->publish(topics::imu(), ros_codec::encode(imu));
    run_for(10ms);
  }
  pitched_scan();
  run_for(500ms);
  ASSERT_EQ(perceived_.size(), 2u);
  EXPECT_TRUE(perceived_[1].up_is_measured);
  EXPECT_LT((perceived_[1].up_in_base - Eigen::Vector3d::UnitZ()).norm(), 0.02);
}

TEST_F(FramedSensors, WithoutFramesAreUsedAtTheirDefaultAfterTheWait) {
  pitched_scan();
  run_for(1900ms);
  pitched_scan();
  run_for(100ms);
  EXPECT_TRUE(perceived_.empty());
  pitched_scan();
  run_for(500ms);
  ASSERT_EQ(perceived_.size(), 1u);
  EXPECT_EQ(perception_->counters().waited_for_frames, 2u);
  EXPECT_LT(lowest_point(), -0.8f) << "tilted, as nothing says otherwise";
}

}  // namespace
}  // namespace fleetmap::agent
