#include "fleetmap/eval/consistency.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace fleetmap::eval {
namespace {

/// Errors drawn from N(0, C), stated with a covariance of `stated` * C.
std::vector<StatedError> drawn(int count, double stated) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  Matrix6d root = Matrix6d::Identity();
  root(1, 0) = 0.7;  // correlated
  root(5, 2) = -0.4;
  const Vector6d scale{0.1, 0.02, 0.3, 1e-3, 2e-3, 5e-4};
  root = scale.asDiagonal() * root;
  std::vector<StatedError> errors;
  for (int k = 0; k < count; ++k) {
    Vector6d white;
    for (int axis = 0; axis < 6; ++axis) white[axis] = normal(random);
    errors.push_back({root * white, stated * root * root.transpose()});
  }
  return errors;
}

TEST(Consistency, NeesOfHonestCovariancesIsOne) {
  const Consistency c = consistency(drawn(4000, 1.0));
  EXPECT_EQ(c.count, 4000u);
  EXPECT_EQ(c.dimensions, 6u);
  EXPECT_NEAR(c.mean, 1.0, 0.05);
  EXPECT_NEAR(c.median, c.expected_median, 0.05);
  EXPECT_NEAR(c.within_95, 0.95, 0.015);
  ASSERT_EQ(c.axes.size(), 6u);
  for (const double axis : c.axes) EXPECT_NEAR(axis, 1.0, 0.05);
}

TEST(Consistency, ShowsErrorsTwiceAsLargeAsStated) {
  const Consistency c = consistency(drawn(2000, 0.25));
  EXPECT_NEAR(c.mean, 4.0, 0.3);
  for (const double axis : c.axes) EXPECT_NEAR(axis, 2.0, 0.15);
  EXPECT_LT(c.within_95, 0.2);
}

TEST(Consistency, RefusesWhatIsNoCovariance) {
  std::vector<StatedError> errors = drawn(10, 1.0);
  errors[1].covariance.setZero();
  errors[2].covariance(0, 0) = -1.0;
  errors[3].error[0] = std::numeric_limits<double>::quiet_NaN();
  errors[4].error = Eigen::VectorXd::Zero(2);
  const Consistency c = consistency(errors);
  EXPECT_EQ(c.count, 6u);
  EXPECT_EQ(c.refused, 4u);
  EXPECT_EQ(consistency({}).count, 0u);
}

TEST(Consistency, TangentErrorIsThatOfTheRightTangent) {
  const Pose T = se3_exp(Vector6d{3.0, -2.0, 1.0, 0.3, -0.1, 1.2});
  const Vector6d e{0.1, -0.2, 0.05, 0.01, 0.02, -0.03};
  EXPECT_LT((tangent_error(T, T * se3_exp(e)) - e).norm(), 1e-9);
}

TEST(Spread, TellsQuantiles) {
  std::vector<double> values;
  for (int k = 100; k >= 0; --k) values.push_back(k);
  const Spread s = spread(values);
  EXPECT_EQ(s.count, 101u);
  EXPECT_DOUBLE_EQ(s.p50, 50.0);
  EXPECT_DOUBLE_EQ(s.p90, 90.0);
  EXPECT_DOUBLE_EQ(s.max, 100.0);
  EXPECT_NEAR(s.rms, std::sqrt(3350.0), 1e-9);
  EXPECT_EQ(spread({}).count, 0u);
}

}  // namespace
}  // namespace fleetmap::eval
