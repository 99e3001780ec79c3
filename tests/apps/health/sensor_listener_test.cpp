#include "health/sensor_listener.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <numbers>
#include <sstream>
#include <utility>

#include "apps/made_robot.hpp"
#include "fleetmap/bus/local_network.hpp"
#include "fleetmap/ros_codec/point_cloud2.hpp"
#include "recordings/sample_player.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ContainsRegex;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class SensorListenerTest : public ::testing::Test {
 protected:
  void publish(const recording::Sample& sample) {
    const EncodedSample encoded = encode(sample, config_.topics);
    robot_.publish(encoded.topic, encoded.cdr);
    network_->run_until(network_->now() + std::chrono::milliseconds(10));
  }
  std::string streams() const {
    std::ostringstream out;
    listener_.streams().print(out);
    return out.str();
  }

  std::unique_ptr<bus::LocalNetwork> network_ = bus::LocalNetwork::create({}).value();
  bus::Bus& robot_ = network_->add_robot(AgentId::parse("r1").value());
  agent::PerceptionConfig config_;
  SensorListener listener_{config_, robot_};
};

TEST_F(SensorListenerTest, CountsTheSamplesOfAllFourSensors) {
  for (int k = 0; k < 3; ++k) {
    const Stamp now = robot_.now();
    publish(sensor::Scan{now, false, false, {{{1.0f, 2.0f, 3.0f}, 0.0f, 0.0f, 0}}});
    sensor::Imu imu;
    imu.stamp = now;
    imu.specific_force = {0.0, 0.0, 9.81};
    publish(imu);
    publish(sensor::Fix{now, {0.7, 0.1, 600.0}});
    publish(sensor::Wheel{now, 1.0, 0.0});
  }
  EXPECT_EQ(listener_.streams().scans(), 3u);
  EXPECT_THAT(streams(), AllOf(ContainsRegex("LiDAR +3 "), ContainsRegex("IMU +3 "), ContainsRegex("GPS +3 "),
                               ContainsRegex("wheels +3 ")));
}

TEST_F(SensorListenerTest, WhatCannotBeDecodedIsCountedByItsReason) {
  EXPECT_THAT(listener_.findings(), IsEmpty());
  const bus::Topic imu = sensor_topics(config_.topics)[1];
  for (int k = 0; k < 2; ++k) {
    robot_.publish(imu, Bytes{0, 1, 0, 0, 7});
    network_->run_until(network_->now() + std::chrono::milliseconds(10));
  }
  EXPECT_THAT(listener_.findings(), Contains(AllOf(HasSubstr(imu.name + ": "), HasSubstr(" (2 messages)"))));
}

TEST_F(SensorListenerTest, TwoLidarsOnOneTopicAreAFinding) {
  for (int k = 0; k < 4; ++k) {
    const sensor::Scan scan{robot_.now(), false, false, {{{1.0f, 2.0f, 3.0f}, 0.0f, 0.0f, 0}}};
    robot_.publish(sensor_topics(config_.topics)[0], ros_codec::encode(scan, k % 2 == 0 ? "front" : "rear"));
    network_->run_until(network_->now() + std::chrono::milliseconds(10));
  }
  EXPECT_THAT(listener_.findings(), Contains(HasSubstr("'front' and 'rear': two LiDARs publish on it")));
}

TEST_F(SensorListenerTest, EachSilentTopicIsNamedWithItsRemedy) {
  EXPECT_THAT(
      listener_.silent_topics(),
      ElementsAre(AllOf(HasSubstr("no sample on rt/imu: "), HasSubstr("(topics.imu)")),
                  AllOf(HasSubstr("no sample on rt/fix: "), HasSubstr("gps.use: false")),
                  AllOf(HasSubstr("no sample on rt/wheel_odometry: "), HasSubstr("odometry.use_wheel"))));
  publish(sensor::Wheel{robot_.now(), 1.0, 0.0});
  robot_.publish(sensor_topics(config_.topics)[1], Bytes{0, 1, 0, 0, 7});
  network_->run_until(network_->now() + std::chrono::milliseconds(10));
  EXPECT_THAT(listener_.silent_topics(), ElementsAre(HasSubstr("no sample on rt/fix: ")))
      << "what cannot be decoded is a finding already";
}

TEST_F(SensorListenerTest, TopicsThatAreNotUsedMayBeSilent) {
  agent::PerceptionConfig config;
  config.odometry_uses_imu = config.odometry_uses_wheel = config.uses_gps = false;
  EXPECT_THAT(SensorListener(config, robot_).silent_topics(), IsEmpty());
}

/// A robot as its drivers have it, heard for 12 s of a drive: (findings, notes).
struct Heard {
  std::vector<std::string> findings, notes;
};
Heard heard(const std::function<void(recording::Sample&)>& spoil, double speed = 1.5) {
  static const std::vector<SentSample> driven = samples_of_a_robot(1.5, 12.0, kStart);
  bus::LocalNetworkConfig network_config;
  network_config.start = kStart;
  network_config.perception_time = std::chrono::milliseconds(30);
  const auto network = bus::LocalNetwork::create(network_config).value();
  bus::Bus& robot = network->add_robot(AgentId::parse("r1").value());
  agent::PerceptionConfig config;
  config.odometry.T_base_lidar = testing::ScanOptions{}.T_base_lidar;
  config.mount_configured.fill(true);
  SensorListener listener(config, robot);
  for (SentSample sent : speed > 0.0 ? driven : samples_of_a_robot(0.0, 4.0, kStart)) {
    spoil(sent.sample);
    network->run_until(sent.sent);
    const EncodedSample encoded = encode(sent.sample, config.topics);
    robot.publish(encoded.topic, encoded.cdr);
  }
  network->run_until(network->now() + std::chrono::seconds(1));
  EXPECT_TRUE(listener.idle());
  return {listener.findings(), listener.notes()};
}

template <class T>
std::function<void(recording::Sample&)> each(std::function<void(T&)> change) {
  return [change](recording::Sample& sample) {
    if (auto* one = std::get_if<T>(&sample)) change(*one);
  };
}

TEST(SensorListenerMotions, OfASoundRobotAllIsComparedAndNothingFound) {
  const Heard sound = heard([](recording::Sample&) {});
  EXPECT_THAT(sound.findings, IsEmpty());
  EXPECT_THAT(sound.notes, IsEmpty());
}

TEST(SensorListenerMotions, ARobotThatStandsIsToldThatNothingWasCompared) {
  const Heard standing = heard([](recording::Sample&) {}, 0.0);
  EXPECT_THAT(standing.findings, IsEmpty());
  EXPECT_THAT(standing.notes, ElementsAre(HasSubstr("motions not compared: ")));
}

TEST(SensorListenerMotions, TheWrongSensorIsNamed) {
  using sensor::Imu, sensor::Scan, sensor::Wheel;
  static constexpr double kDegree = std::numbers::pi / 180.0;
  const std::vector<std::pair<std::string, std::function<void(recording::Sample&)>>> cases{
      {"deg/s", each<Imu>([](Imu& imu) { imu.angular_velocity /= kDegree; })},
      {"the sign of its z axis is wrong", each<Imu>([](Imu& imu) { imu.angular_velocity.z() *= -1.0; })},
      {"its axes are swapped",
       each<Imu>([](Imu& imu) { std::swap(imu.angular_velocity.x(), imu.angular_velocity.z()); })},
      {"the gyro turns", each<Imu>([](Imu& imu) { imu.stamp -= std::chrono::milliseconds(200); })},
      {"the gyro turns", each<Scan>([](Scan& scan) { scan.stamp += std::chrono::milliseconds(100); })},
      {"km/h", each<Wheel>([](Wheel& wheel) { wheel.forward_speed *= 3.6; })},
      {"drives backwards", each<Wheel>([](Wheel& wheel) { wheel.forward_speed *= -1.0; })},
      {"it stands while the LiDAR moves", each<Wheel>([](Wheel& wheel) {
         wheel = {wheel.stamp, 0.0, std::nullopt};
       })},
      {"its points are mirrored", each<Scan>([](Scan& scan) {
         for (sensor::ScanPoint& point : scan.points) point.position.y() *= -1.0f;
       })},
      {"deg more yaw", each<Scan>([](Scan& scan) {
         for (sensor::ScanPoint& point : scan.points)
           point.position = Eigen::Vector3f(point.position.y(), -point.position.x(), point.position.z());
       })},
  };
  for (const auto& [named, spoil] : cases)
    EXPECT_THAT(heard(spoil).findings, Contains(HasSubstr(named))) << named;
}

}  // namespace
}  // namespace fleetmap::apps
