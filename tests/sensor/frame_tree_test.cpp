#include "fleetmap/sensor/frame_tree.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace fleetmap::sensor {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const Eigen::Quaterniond kPitch(rotation_from_rpy(0.0, 0.35, 0.0));

/// base_footprint -> base_link -> mast -> velodyne, and a camera of a rig that nothing holds.
FrameTree robot() {
  FrameTree tree;
  for (const FrameTransform& transform :
       {FrameTransform{"base_footprint", "base_link", {0.0, 0.0, 0.1}},
        FrameTransform{
            "base_link", "mast", {0.1, 0.0, 0.5}, Eigen::Quaterniond(rotation_from_rpy(0, 0, M_PI_2))},
        FrameTransform{"mast", "velodyne", {0.2, 0.0, 0.3}, kPitch}, FrameTransform{"rig", "camera"}}) {
    EXPECT_TRUE(tree.add(transform));
  }
  return tree;
}

std::string error_of(const Result<Pose>& found) { return found ? "" : found.error().message; }

TEST(FrameTree, ResolvesAChainUpAndDown) {
  const auto T = robot().find("base_link", "/velodyne");
  ASSERT_TRUE(T) << T.error().message;
  // The mast is turned to the left: what is ahead of it is to the left of base_link.
  EXPECT_TRUE(T->translation().isApprox(Eigen::Vector3d(0.1, 0.2, 0.8), 1e-12)) << T->translation();
  EXPECT_TRUE(T->linear().isApprox(rotation_from_rpy(0, 0, M_PI_2) * kPitch.toRotationMatrix(), 1e-12));
  const auto up = robot().find("velodyne", "base_footprint");
  ASSERT_TRUE(up);
  EXPECT_TRUE((*up * Eigen::Vector3d(0.1, 0.2, 0.9)).isZero(1e-12)) << "the LiDAR is in its own origin";
}

TEST(FrameTree, AMissingLinkIsNamed) {
  EXPECT_THAT(
      error_of(robot().find("base_link", "camera")),
      AllOf(HasSubstr("'camera' leads up to 'rig'"), HasSubstr("'base_link' leads up to 'base_footprint'")));
  EXPECT_THAT(error_of(robot().find("base_link", "os_lidar")), HasSubstr("'os_lidar' has no parent"));
}

TEST(FrameTree, ACycleIsNamed) {
  FrameTree tree = robot();
  ASSERT_TRUE(tree.add({"velodyne", "base_footprint"}));
  EXPECT_THAT(error_of(tree.find("base_link", "velodyne")), HasSubstr("'base_link' form a cycle"));
}

TEST(FrameTree, ALaterTransformReplacesAnEarlierOne) {
  FrameTree tree = robot();
  ASSERT_TRUE(tree.add({"base_link", "mast", {1.0, 0.0, 0.0}}));
  EXPECT_TRUE(tree.find("base_link", "mast")->translation().isApprox(Eigen::Vector3d::UnitX()));
}

TEST(FrameTree, InvalidTransformsAreNamedAndTheOthersUsed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  SensorFrames frames;
  frames.add({{"base_link", "a", {nan, 0.0, 0.0}},
              {"base_link", "b", {}, Eigen::Quaterniond(0.0, 0.0, 0.0, 0.0)},
              {"base_link", "c", {}, Eigen::Quaterniond(nan, 0.0, 0.0, 0.0)},
              {"base_link", "d", {}, Eigen::Quaterniond(1.01, 0.0, 0.0, 0.0)},
              {"base_link", ""},
              {"base_link", "e"},
              {"base_link", "a", {nan, 0.0, 0.0}}});
  EXPECT_THAT(
      frames.refused,
      ::testing::ElementsAre(HasSubstr("'a' has a translation"),
                             HasSubstr("'b' has a quaternion of length 0"), HasSubstr("'c' has a quaternion"),
                             HasSubstr("'d' has a quaternion"), HasSubstr("without a name")));
  for (const char* child : {"a", "b", "c", "d"}) EXPECT_FALSE(frames.tree.find("base_link", child)) << child;
  EXPECT_TRUE(frames.tree.find("base_link", "e"));
}

}  // namespace
}  // namespace fleetmap::sensor
