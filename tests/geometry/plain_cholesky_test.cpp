#include "fleetmap/geometry/plain_cholesky.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <limits>
#include <random>

namespace fleetmap {
namespace {

Eigen::MatrixXd random_matrix(int rows, int columns, std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); });
}

TEST(PlainCholesky, AgreesWithEigen) {
  std::mt19937 random(5);
  for (const int n : {1, 3, 6, 40}) {
    const Eigen::MatrixXd root = random_matrix(n, n, random);
    const Eigen::MatrixXd A = root * root.transpose() + Eigen::MatrixXd::Identity(n, n);
    const Eigen::MatrixXd B = random_matrix(n, 4, random);
    const Eigen::LLT<Eigen::MatrixXd> right(A);
    Eigen::MatrixXd L = A;
    ASSERT_TRUE(plain_cholesky::factor(L.data(), n));
    EXPECT_TRUE(
        L.triangularView<Eigen::Lower>().toDenseMatrix().isApprox(right.matrixL().toDenseMatrix(), 1e-12));
    EXPECT_TRUE(L.triangularView<Eigen::StrictlyUpper>().toDenseMatrix() ==
                A.triangularView<Eigen::StrictlyUpper>().toDenseMatrix());
    Eigen::MatrixXd X = B;
    plain_cholesky::solve_lower(L.data(), n, X.data(), 4);
    EXPECT_TRUE(X.isApprox(right.matrixL().solve(B), 1e-10));
    plain_cholesky::solve_upper(L.data(), n, X.data(), 4);
    EXPECT_TRUE((A * X).isApprox(B, 1e-9));
  }
}

TEST(PlainCholesky, RefusesWhatIsNotPositiveDefinite) {
  Eigen::Matrix3d A = Eigen::Vector3d(1.0, -1.0, 1.0).asDiagonal();
  EXPECT_FALSE(plain_cholesky::factor(A.data(), 3));
  A = Eigen::Matrix3d::Ones();
  EXPECT_FALSE(plain_cholesky::factor(A.data(), 3)) << "singular";
  A = Eigen::Matrix3d::Identity();
  A(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(plain_cholesky::factor(A.data(), 3));
}

}  // namespace
}  // namespace fleetmap
