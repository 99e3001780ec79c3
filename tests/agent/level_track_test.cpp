#include "fleetmap/agent/level_track.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fleetmap::agent {
namespace {

double degrees_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::min(1.0, a.normalized().dot(b.normalized()))) * 180.0 / 3.141592653589793;
}

TEST(LevelTrack, AveragesWhatAccelerationDoesToTheLevel) {
  // The odometry frame leans by 3 deg; the robot turns on the spot, and what the EKF tells sways by 2 deg.
  const Eigen::Vector3d up_in_odom = so3_exp({0.05, 0.02, 0.0}) * Eigen::Vector3d::UnitZ();
  LevelTrack track;
  Pose T_odom_base = Pose::Identity();
  for (int k = 0; k < 600; ++k) {
    const double t = 0.1 * k;
    T_odom_base.linear() = so3_exp({0.0, 0.0, 0.3 * t});
    const Eigen::Vector3d truth = T_odom_base.linear().transpose() * up_in_odom;
    const Eigen::Vector3d told = so3_exp({0.035 * std::sin(0.7 * t), 0.035 * std::cos(0.9 * t), 0.0}) * truth;
    track.add(told, T_odom_base, stamp_from_ns(static_cast<std::int64_t>(1e9 * t)));
  }
  const Eigen::Vector3d truth = T_odom_base.linear().transpose() * up_in_odom;
  EXPECT_LT(degrees_between(track.up_in_base(T_odom_base), truth), 0.4);
}

TEST(LevelTrack, BeforeAnythingWasToldTheOdometrysZIsUp) {
  EXPECT_EQ(LevelTrack{}.up_in_base(Pose::Identity()), Eigen::Vector3d::UnitZ());
}

TEST(LevelTrack, LevellingKeepsTheHeading) {
  GlobalPose G;
  G.q_enu_base = Eigen::Quaterniond(rotation_from_rpy(0.04, -0.03, 1.2));
  const Eigen::Vector3d up = rotation_from_rpy(0.0, 0.01, 0.0).transpose() * Eigen::Vector3d::UnitZ();
  const GlobalPose turned = levelled(G, up);
  EXPECT_NEAR((turned.q_enu_base.conjugate() * Eigen::Vector3d::UnitZ() - up).norm(), 0.0, 1e-12);
  EXPECT_NEAR(rpy_from_rotation(turned.q_enu_base.toRotationMatrix()).z(), 1.2, 2e-3);
}

}  // namespace
}  // namespace fleetmap::agent
