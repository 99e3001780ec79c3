#include "pose_text.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace fleetmap::output {
namespace {

TEST(PoseText, IsTranslationThenQuaternionWithItsRealPartLast) {
  const Pose T = make_pose(rotation_from_rpy(0.0, 0.0, 1.0), {1.25, -2.5, 3.0});
  EXPECT_EQ(pose_text(T, 2, 4), "1.25 -2.50 3.00 0.0000 0.0000 0.4794 0.8776");
  EXPECT_EQ(pose_text(T, 4, 7), "1.2500 -2.5000 3.0000 0.0000000 0.0000000 0.4794255 0.8775826");
}

TEST(PoseText, HasRoomForAnyPose) {
  const double far = std::numeric_limits<float>::max();
  const std::string text = pose_text(make_pose(Eigen::Matrix3d::Identity(), {far, -far, far}), 6, 9);
  EXPECT_EQ(text.substr(text.size() - 11), "1.000000000");
}

TEST(FiniteNumber, IsTheWholeText) {
  EXPECT_EQ(finite_number("-0.5"), -0.5);
  EXPECT_EQ(finite_number("1e3"), 1000.0);
  for (const char* bad : {"", " 1", "1 ", "1,5", "nan", "inf", "1e999", "0x10"})
    EXPECT_FALSE(finite_number(bad)) << bad;
}

}  // namespace
}  // namespace fleetmap::output
