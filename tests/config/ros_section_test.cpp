#include "ros_section.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fleetmap::config {
namespace {

using ::testing::HasSubstr;

struct RosReading {
  ros_output::RosOutputConfig ros;
  std::string problems;
};

RosReading ros_of(const std::string& text) {
  Document document = Document::from(YAML::Load(text), "r1.yaml");
  Section top(document, document.root(), "");
  RosReading reading{read_ros(top), ""};
  if (const Status status = document.status(); !status) reading.problems = status.error().message;
  return reading;
}

TEST(RosSection, ReadsEveryKey) {
  const RosReading reading =
      ros_of("{ros: {publish: false, tf: false, map_voxel: 0.5, map_points: 5000, map_period: 2.5}}");
  ASSERT_EQ(reading.problems, "");
  EXPECT_FALSE(reading.ros.publish);
  EXPECT_FALSE(reading.ros.tf);
  EXPECT_EQ(reading.ros.map_voxel, 0.5);
  EXPECT_EQ(reading.ros.map_points, 5000u);
  EXPECT_EQ(reading.ros.map_period, std::chrono::milliseconds(2500));
}

TEST(RosSection, WithoutItsKeyAllIsPublished) {
  const RosReading reading = ros_of("{id: r1}");
  EXPECT_EQ(reading.problems, "");
  EXPECT_TRUE(reading.ros.publish && reading.ros.tf);
}

TEST(RosSection, ImpossibleValuesAreNamed) {
  EXPECT_THAT(ros_of("{ros: {map_voxel: 0}}").problems, HasSubstr("map_voxel"));
  EXPECT_THAT(ros_of("{ros: {map_voxels: 1}}").problems, HasSubstr("map_voxels"));
}

}  // namespace
}  // namespace fleetmap::config
