#include "fleetmap/geometry/symmetric.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

namespace fleetmap {
namespace {

Matrix6d random_covariance(unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  Matrix6d A;
  for (double& a : A.reshaped()) a = normal(engine);
  return A * A.transpose() + 1e-3 * Matrix6d::Identity();
}

TEST(Symmetric, EigenvectorsDiagonaliseAndEigenvaluesAscend) {
  const Matrix6d A = random_covariance(1);
  const SymmetricEigen eigen = eigen_of_symmetric(A);
  EXPECT_LT((eigen.vectors * eigen.values.asDiagonal() * eigen.vectors.transpose() - A).norm(),
            1e-9 * A.norm());
  EXPECT_LT((eigen.vectors.transpose() * eigen.vectors - Matrix6d::Identity()).norm(), 1e-9);
  for (int k = 1; k < 6; ++k) EXPECT_LE(eigen.values[k - 1], eigen.values[k]);
}

TEST(Symmetric, CholeskyInvertsAndKnowsDistanceAndDeterminant) {
  const Matrix6d A = random_covariance(2);
  const CholeskyOf cholesky(A);
  ASSERT_TRUE(cholesky.positive_definite());
  EXPECT_LT((cholesky.inverse() * A - Matrix6d::Identity()).norm(), 1e-6);
  const Vector6d e = Vector6d::LinSpaced(-1.0, 2.0);
  EXPECT_NEAR(cholesky.squared_distance(e), e.dot(A.inverse() * e), 1e-6 * e.dot(A.inverse() * e));
  EXPECT_NEAR(cholesky.log_det(), std::log(A.determinant()), 1e-6);
}

TEST(Symmetric, CholeskySaysWhatIsNotPositiveDefinite) {
  Matrix6d A = Matrix6d::Identity();
  A(3, 3) = -1.0;
  EXPECT_FALSE(CholeskyOf(A).positive_definite());
}

}  // namespace
}  // namespace fleetmap
