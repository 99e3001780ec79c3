#include "fleetmap/ros_output/ros_output_config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace fleetmap::ros_output {
namespace {

using ::testing::HasSubstr;

TEST(RosOutputConfig, DefaultsAreValidAndWhatIsNotNamesItsKey) {
  EXPECT_TRUE(RosOutputConfig{}.validate());
  RosOutputConfig config;
  for (const double voxel : {0.0, -1.0, 11.0, std::nan("")}) {
    config.map_voxel = voxel;
    EXPECT_THAT(config.validate().error().message, HasSubstr("ros.map_voxel")) << voxel;
  }
  config = {};
  for (const std::size_t points : {999ul, 1'000'001ul}) {
    config.map_points = points;
    EXPECT_THAT(config.validate().error().message, HasSubstr("ros.map_points")) << points;
  }
  config = {};
  config.map_period = std::chrono::milliseconds(999);
  EXPECT_THAT(config.validate().error().message, HasSubstr("ros.map_period"));
}

}  // namespace
}  // namespace fleetmap::ros_output
