#include "fleetmap/agent/gravity_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace fleetmap::agent {
namespace {

double degrees_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::min(1.0, a.normalized().dot(b.normalized()))) * 180.0 / 3.141592653589793;
}

TEST(GravityFilter, AveragesWhatAccelerationDoesToTheLevel) {
  // The odometry frame leans by 3 deg; the robot turns on the spot, and what the EKF tells sways by 2 deg.
  const Eigen::Vector3d up_in_odom = so3_exp({0.05, 0.02, 0.0}) * Eigen::Vector3d::UnitZ();
  GravityFilter track;
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

/// A robot on lanes of 100 m whose IMU leans by `offset` (rad, base_link), which sees the level with white
/// noise, on an odometry frame that leans.
struct Lanes {
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  Eigen::Vector3d up_in_odom = so3_exp({0.02, -0.01, 0.0}) * Eigen::Vector3d::UnitZ();
  std::mt19937 random{1};
  double noise = 0.02;

  /// Seconds at 1.5 m/s. Returns the mean of e^2 / variance, of each axis, after `after` s.
  double drive(GravityFilter& track, double seconds, double after) {
    std::normal_distribution<double> normal(0.0, noise);
    double sum = 0.0;
    int count = 0;
    for (double t = 0.0; t < seconds; t += 0.2) {
      T_odom_base.linear() = so3_exp({0.0, 0.0, static_cast<int>(t / 66.0) % 2 == 0 ? 0.3 : 0.3 + M_PI});
      const Eigen::Vector3d truth = T_odom_base.linear().transpose() * up_in_odom;
      const Eigen::Vector3d lean = offset + Eigen::Vector3d(normal(random), normal(random), 0.0);
      track.add(so3_exp(lean) * truth, T_odom_base, stamp_from_ns(static_cast<std::int64_t>(1e9 * t)));
      if (t < after || !track.variance()) continue;
      error = track.up_in_base(T_odom_base) - truth;
      sum += 0.5 * error.squaredNorm() / *track.variance();
      ++count;
    }
    return sum / count;
  }

  Pose T_odom_base = Pose::Identity();
  Eigen::Vector3d error = Eigen::Vector3d::Zero();  ///< at the end
};

TEST(GravityFilter, AnImuThatLeansIsFoundByTurningRound) {
  Lanes lanes;
  lanes.offset = {0.008, -0.006, 0.0};
  GravityFilter straight, lanes_there_and_back;
  lanes.drive(straight, 60.0, 0.0);
  EXPECT_GT(lanes.error.norm(), 0.005) << "one heading cannot tell it";
  EXPECT_GT(std::sqrt(2.0 * *straight.variance()), lanes.error.norm()) << "and it is stated";
  lanes.drive(lanes_there_and_back, 600.0, 300.0);
  EXPECT_LT(lanes.error.norm(), 0.002);
  EXPECT_LT(std::sqrt(*lanes_there_and_back.variance()), 0.002);
}

TEST(GravityFilter, StatesWhatItErrsBy) {
  for (const double noise : {0.003, 0.02, 0.06}) {
    double nees = 0.0;
    for (unsigned seed = 1; seed <= 20; ++seed) {
      Lanes lanes;
      lanes.noise = noise;
      lanes.random.seed(seed);
      std::normal_distribution<double> offset(0.0, 0.004);
      lanes.offset = {offset(lanes.random), offset(lanes.random), 0.0};
      GravityFilter track;
      nees += lanes.drive(track, 600.0, 200.0) / 20.0;
    }
    EXPECT_LT(nees, 1.3) << "noise " << noise;
    EXPECT_GT(nees, 0.02) << "noise " << noise;
  }
}

TEST(GravityFilter, BeforeAnythingWasToldTheOdometrysZIsUp) {
  EXPECT_EQ(GravityFilter{}.up_in_base(Pose::Identity()), Eigen::Vector3d::UnitZ());
}

TEST(GravityFilter, LevellingKeepsTheHeading) {
  GlobalPose G;
  G.q_enu_base = Eigen::Quaterniond(rotation_from_rpy(0.04, -0.03, 1.2));
  const Eigen::Vector3d up = rotation_from_rpy(0.0, 0.01, 0.0).transpose() * Eigen::Vector3d::UnitZ();
  const GlobalPose turned = levelled(G, up);
  EXPECT_NEAR((turned.q_enu_base.conjugate() * Eigen::Vector3d::UnitZ() - up).norm(), 0.0, 1e-12);
  EXPECT_NEAR(rpy_from_rotation(turned.q_enu_base.toRotationMatrix()).z(), 1.2, 2e-3);
  EXPECT_TRUE(turned.covariance == G.covariance);
  const Matrix6d stated = levelled(G, up, 1e-6).covariance;
  EXPECT_EQ(stated(3, 3), 1e-6);
  EXPECT_EQ(stated(4, 4), 1e-6);
  EXPECT_EQ(stated(5, 5), G.covariance(5, 5));
}

}  // namespace
}  // namespace fleetmap::agent
