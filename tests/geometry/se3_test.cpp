#include "fleetmap/geometry/se3.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace fleetmap {
namespace {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  Vector6d tangent(double scale) {
    Vector6d xi;
    for (int k = 0; k < 6; ++k) xi[k] = std::uniform_real_distribution<double>(-scale, scale)(engine_);
    return xi;
  }
  Pose pose() { return se3_exp(tangent(1.5)); }

 private:
  std::mt19937 engine_;
};

double difference(const Pose& a, const Pose& b) { return (a.matrix() - b.matrix()).norm(); }

TEST(Se3, LogInvertsExp) {
  Random random(1);
  for (const double scale : {1e-9, 1e-6, 1e-3, 1.0, 1.7}) {
    for (int k = 0; k < 200; ++k) {
      const Vector6d xi = random.tangent(scale);
      EXPECT_LT((se3_log(se3_exp(xi)) - xi).norm(), 1e-9 * std::max(1.0, scale)) << xi.transpose();
    }
  }
}

TEST(Se3, LogIsFiniteAndShortNearHalfTurns) {
  for (const double angle : {std::numbers::pi - 1e-7, std::numbers::pi, std::numbers::pi + 1e-7}) {
    for (const Eigen::Vector3d& axis : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(1, 2, 3).normalized()}) {
      const Eigen::Matrix3d R = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
      const Eigen::Vector3d phi = so3_log(R);
      EXPECT_LE(phi.norm(), std::numbers::pi + 1e-9);
      EXPECT_LT((so3_exp(phi) - R).norm(), 1e-6);
    }
  }
}

TEST(Se3, ExpOfSumAlongOneDirectionIsProduct) {
  Random random(2);
  for (int k = 0; k < 100; ++k) {
    const Vector6d xi = random.tangent(1.0);
    EXPECT_LT(difference(se3_exp(0.3 * xi) * se3_exp(0.7 * xi), se3_exp(xi)), 1e-12);
  }
}

TEST(Se3, AdjointMovesTangentsAcross) {
  Random random(3);
  for (int k = 0; k < 100; ++k) {
    const Pose T = random.pose();
    const Vector6d xi = random.tangent(0.5);
    EXPECT_LT(difference(T * se3_exp(xi) * T.inverse(), se3_exp(Vector6d(adjoint(T) * xi))), 1e-12);
  }
}

TEST(Se3, InterpolationPassesThroughBothEndsAndIsFrameInvariant) {
  Random random(4);
  for (int k = 0; k < 100; ++k) {
    const Pose a = random.pose();
    const Pose b = random.pose();
    const Pose w = random.pose();
    EXPECT_LT(difference(interpolate(a, b, 0.0), a), 1e-12);
    EXPECT_LT(difference(interpolate(a, b, 1.0), b), 1e-9);
    EXPECT_LT(difference(w * interpolate(a, b, 0.4), interpolate(w * a, w * b, 0.4)), 1e-9);
  }
}

TEST(Se3, RollPitchYawRoundTrip) {
  Random random(5);
  for (int k = 0; k < 100; ++k) {
    const Eigen::Vector3d rpy = random.tangent(1.4).head<3>();
    EXPECT_LT((rpy_from_rotation(rotation_from_rpy(rpy.x(), rpy.y(), rpy.z())) - rpy).norm(), 1e-9);
  }
}

TEST(Se3, MinimalRotationTurnsOneDirectionIntoTheOtherAndNoFurther) {
  Random random(6);
  for (int k = 0; k < 100; ++k) {
    const Eigen::Vector3d from = random.tangent(3.0).head<3>(), to = random.tangent(3.0).head<3>();
    const Eigen::Quaterniond q = minimal_rotation(from, to);
    EXPECT_LT((q * from.normalized() - to.normalized()).norm(), 1e-9);
    const double between = std::acos(std::clamp(from.normalized().dot(to.normalized()), -1.0, 1.0));
    EXPECT_NEAR(q.angularDistance(Eigen::Quaterniond::Identity()), between, 1e-6);
    EXPECT_LT((levelling(from) * from.normalized() - Eigen::Vector3d::UnitZ()).norm(), 1e-9);
  }
  EXPECT_LT((levelling({0.0, 0.0, -2.0}) * Eigen::Vector3d(0.0, 0.0, -1.0) - Eigen::Vector3d::UnitZ()).norm(),
            1e-9);
  EXPECT_TRUE(levelling(Eigen::Vector3d::Zero()).isIdentity());
  EXPECT_TRUE(levelling({0.0, std::numeric_limits<double>::quiet_NaN(), 1.0}).isIdentity());
}

TEST(Se3, WrapAngleLandsInTheHalfOpenTurn) {
  for (double angle = -20.0; angle < 20.0; angle += 0.137) {
    const double wrapped = wrap_angle(angle);
    EXPECT_GT(wrapped, -std::numbers::pi);
    EXPECT_LE(wrapped, std::numbers::pi);
    EXPECT_NEAR(std::sin(wrapped), std::sin(angle), 1e-12);
    EXPECT_NEAR(std::cos(wrapped), std::cos(angle), 1e-12);
  }
  EXPECT_DOUBLE_EQ(wrap_angle(-std::numbers::pi), std::numbers::pi);
}

}  // namespace
}  // namespace fleetmap
