#include "sensor_listener.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "fleetmap/bus/local_network.hpp"
#include "sample_player.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ContainsRegex;
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

}  // namespace
}  // namespace fleetmap::apps
