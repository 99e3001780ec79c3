#include "solver/block_cholesky.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <numeric>
#include <random>
#include <utility>

namespace fleetmap::graph {
namespace {

/// A random sparse positive definite matrix of blocks of 6 and 3, and the same as a dense one.
struct Random {
  explicit Random(unsigned seed) : random(seed) {
    for (int i = 0; i < 30; ++i) dims.push_back(i % 3 == 2 ? 3 : 6);
    for (int i = 1; i < 25; ++i) pairs.emplace_back(i - 1, i);  // the last five hang on nothing
    for (int k = 0; k < 8; ++k) {
      const auto at = [&] { return static_cast<int>(random() % 25); };
      const std::pair<int, int> pair(at(), at());
      if (pair.first == pair.second || std::ranges::find(pairs, pair) != pairs.end()) continue;
      if (std::ranges::find(pairs, std::pair(pair.second, pair.first)) != pairs.end()) continue;
      pairs.push_back(pair);
      filled = pairs.size() - (random() % 2);  // some of the pairs get nothing
    }
  }

  void fill(BlockCholesky& A) {
    Eigen::Index size = 0;
    std::vector<Eigen::Index> at;
    for (const int dim : dims) at.push_back(std::exchange(size, size + dim));
    dense = Eigen::MatrixXd::Zero(size, size);
    const auto add = [&]<int I, int J>(int i, int j, const Eigen::Matrix<double, I, J>& block) {
      A.add<I, J>(i, j, block);
      const auto a = at[static_cast<std::size_t>(i)], b = at[static_cast<std::size_t>(j)];
      dense.block<I, J>(a, b) += block;
      if (i != j) dense.block<J, I>(b, a) += block.transpose();
    };
    const auto number = [&] { return std::uniform_real_distribution<double>(-1.0, 1.0)(random); };
    for (int i = 0; i < 30; ++i) {
      if (dims[static_cast<std::size_t>(i)] == 6) {
        add(i, i, Matrix6d(30.0 * Matrix6d::Identity()));
      } else {
        add(i, i, Eigen::Matrix3d(30.0 * Eigen::Matrix3d::Identity()));
      }
    }
    for (std::size_t k = 0; k < filled; ++k) {
      const auto [i, j] = pairs[k];
      const int rows = dims[static_cast<std::size_t>(i)], cols = dims[static_cast<std::size_t>(j)];
      if (rows == 6 && cols == 6) add(i, j, Eigen::Matrix<double, 6, 6>::NullaryExpr(number).eval());
      if (rows == 6 && cols == 3) add(i, j, Eigen::Matrix<double, 6, 3>::NullaryExpr(number).eval());
      if (rows == 3 && cols == 6) add(i, j, Eigen::Matrix<double, 3, 6>::NullaryExpr(number).eval());
      if (rows == 3 && cols == 3) add(i, j, Eigen::Matrix<double, 3, 3>::NullaryExpr(number).eval());
    }
  }

  std::mt19937 random;
  std::vector<int> dims;
  std::vector<std::pair<int, int>> pairs;
  std::size_t filled = 0;
  Eigen::MatrixXd dense;
};

TEST(BlockCholesky, SolvesAndInvertsAsADenseMatrixDoes) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    Random random(seed);
    BlockCholesky A(random.dims, random.pairs);
    std::vector<int> all(random.dims.size());
    std::iota(all.begin(), all.end(), 0);
    for (int again = 0; again < 2; ++again) {
      A.set_zero();
      random.fill(A);
      ASSERT_TRUE(A.factor());
      const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(random.dense.rows(), -1.0, 2.0);
      EXPECT_TRUE(A.solve(b).isApprox(random.dense.ldlt().solve(b), 1e-9)) << "seed " << seed;
      A.invert(all);
      const Eigen::MatrixXd inverse = random.dense.inverse();
      std::size_t found = 0;
      for (int i = 0; i < 30; ++i) {
        for (int j = 0; j < 30; ++j) {
          if (random.dims[static_cast<std::size_t>(i)] != 6 || random.dims[static_cast<std::size_t>(j)] != 6)
            continue;
          const auto block = A.inverse_block(i, j);
          const Matrix6d expected = inverse.block<6, 6>(static_cast<Eigen::Index>(A.offset(i)),
                                                        static_cast<Eigen::Index>(A.offset(j)));
          if (block) {
            EXPECT_LT((*block - expected).norm(), 1e-9) << "seed " << seed << ": " << i << ' ' << j;
          }
          found += block.has_value();
          const std::array<std::pair<int, Matrix6d>, 1> of_i{{{i, Matrix6d::Identity()}}},
              of_j{{{j, Matrix6d::Identity()}}};
          EXPECT_LT((BlockCholesky::inner(A.forward(of_i), A.forward(of_j)) - expected).norm(), 1e-9);
        }
      }
      EXPECT_GT(found, 60u);
    }
  }
}

TEST(BlockCholesky, RefusesWhatIsNotPositiveDefinite) {
  BlockCholesky A({6, 3}, {{0, 1}});
  A.set_zero();
  A.add<6, 6>(0, 0, Matrix6d::Identity());
  A.add<3, 3>(1, 1, -Eigen::Matrix3d::Identity());
  EXPECT_FALSE(A.factor());
}

}  // namespace
}  // namespace fleetmap::graph
