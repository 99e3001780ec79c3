#include "fleetmap/geometry/rotated_covariance.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace fleetmap {
namespace {

TEST(RotatedCovariance, AxesAreThoseOfTheOtherFrame) {
  // Frame b has its x axis along a's y axis.
  const Eigen::Matrix3d R_a_b = rotation_from_rpy(0.0, 0.0, std::numbers::pi / 2.0);
  Matrix6d C = Matrix6d::Zero();
  C.diagonal() << 4.0, 1.0, 0.25, 0.3, 0.1, 0.2;
  C(0, 3) = C(3, 0) = 0.5;
  Matrix6d expected = Matrix6d::Zero();
  expected.diagonal() << 1.0, 4.0, 0.25, 0.1, 0.3, 0.2;
  expected(1, 4) = expected(4, 1) = 0.5;
  EXPECT_TRUE(rotated(C, R_a_b).isApprox(expected, 1e-12)) << rotated(C, R_a_b);
}

}  // namespace
}  // namespace fleetmap
