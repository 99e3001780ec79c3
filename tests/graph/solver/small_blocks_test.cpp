#include "solver/small_blocks.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>
#include <vector>

namespace fleetmap::graph {
namespace {

template <int N>
Eigen::Matrix<double, N, N> random_positive_definite() {
  const Eigen::Matrix<double, N, N> A = Eigen::Matrix<double, N, N>::Random();
  return A * A.transpose() + Eigen::Matrix<double, N, N>::Identity();
}

TEST(SmallBlocks, CallsWithTheDimensionAsAConstant) {
  std::vector<int> dims;
  for (const int dim : {3, 6})
    with_dim(dim, [&](auto constant) { dims.push_back(decltype(constant)::value); });
  EXPECT_EQ(dims, (std::vector<int>{3, 6}));
}

template <int N>
void expect_factor() {
  const Eigen::Matrix<double, N, N> A = random_positive_definite<N>();
  Eigen::Matrix<double, N, N> L = A;
  ASSERT_TRUE(factor_diagonal<N>(L.data()));
  EXPECT_TRUE((L * L.transpose()).isApprox(A, 1e-12));
  EXPECT_TRUE(L.isLowerTriangular(0.0)) << "zero above";
}

TEST(SmallBlocks, FactorsAPositiveDefiniteBlock) {
  expect_factor<3>();
  expect_factor<6>();
}

TEST(SmallBlocks, RefusesBlocksThatAreNotPositiveDefinite) {
  Eigen::Matrix3d indefinite = Eigen::Vector3d(1.0, -1.0, 1.0).asDiagonal();
  EXPECT_FALSE(factor_diagonal<3>(indefinite.data()));
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Eigen::Matrix3d broken = Eigen::Matrix3d::Identity();
    broken(2, 1) = bad;
    EXPECT_FALSE(factor_diagonal<3>(broken.data())) << bad;
  }
}

template <int I, int J>
void expect_quotient() {
  Eigen::Matrix<double, J, J> L = random_positive_definite<J>();
  ASSERT_TRUE(factor_diagonal<J>(L.data()));
  const Eigen::Matrix<double, I, J> A = Eigen::Matrix<double, I, J>::Random();
  Eigen::Matrix<double, I, J> X = A;
  divide(I, J, X.data(), L.data());
  EXPECT_TRUE((X * L.transpose()).isApprox(A, 1e-12)) << I << " x " << J;
}

TEST(SmallBlocks, DividesBlocksOfAllDimensions) {
  expect_quotient<3, 3>();
  expect_quotient<3, 6>();
  expect_quotient<6, 3>();
  expect_quotient<6, 6>();
}

}  // namespace
}  // namespace fleetmap::graph
