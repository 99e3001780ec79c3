#include "ros_section.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fleetmap::config {
namespace {

using ::testing::HasSubstr;

struct Reading {
  ros_output::RosOutputConfig ros;
  std::string problems;
};

Reading read(const std::string& text) {
  Document document = Document::from(YAML::Load(text), "r1.yaml");
  Section top(document, document.root(), "");
  Reading reading{read_ros(top), ""};
  if (const Status status = document.status(); !status) reading.problems = status.error().message;
  return reading;
}

TEST(RosSection, ReadsEveryKey) {
  const Reading reading =
      read("{ros: {publish: false, tf: false, map_voxel: 0.5, map_points: 5000, map_period: 2.5}}");
  ASSERT_EQ(reading.problems, "");
  EXPECT_FALSE(reading.ros.publish);
  EXPECT_FALSE(reading.ros.tf);
  EXPECT_EQ(reading.ros.map_voxel, 0.5);
  EXPECT_EQ(reading.ros.map_points, 5000u);
  EXPECT_EQ(reading.ros.map_period, std::chrono::milliseconds(2500));
}

TEST(RosSection, WithoutItsKeyAllIsPublished) {
  const Reading reading = read("{id: r1}");
  EXPECT_EQ(reading.problems, "");
  EXPECT_TRUE(reading.ros.publish && reading.ros.tf);
}

TEST(RosSection, ImpossibleValuesAreNamed) {
  EXPECT_THAT(read("{ros: {map_voxel: 0}}").problems, HasSubstr("map_voxel"));
  EXPECT_THAT(read("{ros: {map_voxels: 1}}").problems, HasSubstr("map_voxels"));
}

}  // namespace
}  // namespace fleetmap::config
