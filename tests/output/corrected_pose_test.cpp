#include "corrected_pose.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace fleetmap::output {
namespace {

Pose pose_at(double x, double y) {
  return make_pose(Eigen::Matrix3d::Identity(), Eigen::Vector3d(x, y, 0.0));
}
Stamp seconds(double s) { return stamp_from_ns(static_cast<std::int64_t>(s * 1e9)); }

TEST(CorrectedPose, MovesAlongWithTheNodesAndJumpsNowhere) {
  const std::vector<CorrectedNode> nodes{{seconds(10), pose_at(0, 0), pose_at(100, 1)},
                                         {seconds(20), pose_at(10, 0), pose_at(110, 3)}};
  const auto y = [&](double s) {
    return corrected_pose(nodes, Pose::Identity(), {seconds(s), pose_at(s - 10.0, 0)}).translation().y();
  };
  EXPECT_DOUBLE_EQ(y(5.0), 1.0);
  EXPECT_DOUBLE_EQ(y(10.0), 1.0);
  EXPECT_NEAR(y(15.0), 2.0, 1e-9);
  EXPECT_NEAR(y(20.0 - 1e-6), 3.0, 1e-6);
  EXPECT_DOUBLE_EQ(y(20.0), 3.0);
  EXPECT_DOUBLE_EQ(y(40.0), 3.0);
}

TEST(CorrectedPose, WithoutNodesTheFrameIsRigid) {
  EXPECT_TRUE(corrected_pose({}, pose_at(7, 7), {seconds(1), pose_at(1, 0)}).isApprox(pose_at(8, 7)));
}

}  // namespace
}  // namespace fleetmap::output
