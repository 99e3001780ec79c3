#include "solver/block_kernels.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cstring>
#include <random>

namespace fleetmap::graph {
namespace {

constexpr int kDims[] = {3, 6};

Eigen::MatrixXd random_block(int rows, int columns, std::mt19937& random) {
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return number(random); });
}

bool same_bits(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0;
}

/// Calls `run(i, k, j)` for all sizes of the three blocks.
template <class Run>
void for_all_sizes(const Run& run) {
  for (const int i : kDims)
    for (const int k : kDims)
      for (const int j : kDims) run(i, k, j);
}

TEST(BlockKernels, SubtractTheProductWithTheTransposeAndGiveTheSameBitsOnEveryProcessor) {
  std::mt19937 random(1);
  for_all_sizes([&](int i, int k, int j) {
    const Eigen::MatrixXd A = random_block(i, k, random), L_ij = random_block(i, j, random),
                          L_kj = random_block(k, j, random);
    Eigen::MatrixXd fast = A, plain = A;
    block_kernels().subtraction(i, k, j)(fast.data(), L_ij.data(), L_kj.data());
    plain_block_kernels().subtraction(i, k, j)(plain.data(), L_ij.data(), L_kj.data());
    EXPECT_TRUE(fast.isApprox(A - L_ij * L_kj.transpose(), 1e-13)) << i << " " << k << " " << j;
    EXPECT_TRUE(same_bits(fast, plain)) << i << " " << k << " " << j;
  });
}

TEST(BlockKernels, SubtractBothProductsOrOneOfThem) {
  std::mt19937 random(2);
  for_all_sizes([&](int i, int k, int j) {
    const Eigen::MatrixXd Z_ik = random_block(i, k, random), U_kj = random_block(k, j, random),
                          U_ij = random_block(i, j, random), Z_ij = random_block(i, j, random),
                          Z_kj = random_block(k, j, random);
    for (const bool with_k : {false, true}) {
      for (const bool with_i : {false, true}) {
        const double* u_kj = with_k ? U_kj.data() : nullptr;
        const double* u_ij = with_i ? U_ij.data() : nullptr;
        Eigen::MatrixXd fast_ij = Z_ij, fast_kj = Z_kj, plain_ij = Z_ij, plain_kj = Z_kj;
        block_kernels().subtraction_of_both(i, k, j)(Z_ik.data(), u_kj, u_ij, fast_ij.data(), fast_kj.data());
        plain_block_kernels().subtraction_of_both(i, k, j)(Z_ik.data(), u_kj, u_ij, plain_ij.data(),
                                                           plain_kj.data());
        const Eigen::MatrixXd expected_ij = with_k ? Eigen::MatrixXd(Z_ij - Z_ik * U_kj) : Z_ij;
        const Eigen::MatrixXd expected_kj = with_i ? Eigen::MatrixXd(Z_kj - Z_ik.transpose() * U_ij) : Z_kj;
        EXPECT_TRUE(fast_ij.isApprox(expected_ij, 1e-13)) << i << " " << k << " " << j;
        EXPECT_TRUE(fast_kj.isApprox(expected_kj, 1e-13)) << i << " " << k << " " << j;
        EXPECT_TRUE(same_bits(fast_ij, plain_ij) && same_bits(fast_kj, plain_kj))
            << i << " " << k << " " << j;
      }
    }
  });
}

}  // namespace
}  // namespace fleetmap::graph
