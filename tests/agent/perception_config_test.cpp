#include "fleetmap/agent/perception_config.hpp"

#include <gtest/gtest.h>

namespace fleetmap::agent {
namespace {

TEST(PerceptionConfig, OurOwnTopicsAreThoseOfRos2OnTheWire) {
  const SensorTopics topics;
  EXPECT_EQ(topics.points, "rt/points");
  for (const std::string& name : {topics.points, topics.imu, topics.fix, topics.wheel})
    EXPECT_TRUE(name.starts_with("rt/")) << name;
}

TEST(PerceptionConfig, DefaultsOfItsPartsAreValid) {
  const PerceptionConfig config;
  EXPECT_TRUE(config.lidar.validate());
  EXPECT_TRUE(config.odometry.validate());
  EXPECT_TRUE(config.localization.validate());
  EXPECT_GT(config.waiting_scans, 0u);
}

}  // namespace
}  // namespace fleetmap::agent
