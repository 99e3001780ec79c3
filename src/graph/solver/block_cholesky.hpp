#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "fleetmap/geometry/se3.hpp"
#include "solver/block_pattern.hpp"

namespace fleetmap::graph {

/// Cholesky factorisation A = L L^T of a sparse symmetric positive definite matrix made of small dense
/// blocks: variables of 6 or 3 numbers. Same input, same bits.
///
/// Written by hand because the covariances of all aligned pairs need the blocks of A^-1 on the pattern of L,
/// which neither CHOLMOD nor Eigen's SimplicialLLT computes. With 20,000 variables and 8,500 alignments these
/// take 0.11 s, and 6 to 25 minutes by solves with those libraries; analysis, factorisation and one solve
/// take 110 ms, with CHOLMOD 213 ms and with SimplicialLLT 288 ms (bench_cholesky).
class BlockCholesky {
 public:
  /// L^-1 H of six columns: its nonzero blocks by column of L in ascending order. Blocks of variables of 3
  /// numbers have zero lower rows.
  using Sparse = std::vector<std::pair<int, Matrix6d>>;

  /// `dims` of the variables (3 or 6), and the pairs of variables that share a factor. They are eliminated in
  /// `order`, or in one that keeps L sparse if it is empty.
  BlockCholesky(std::vector<int> dims, const std::vector<std::pair<int, int>>& pairs,
                const std::vector<int>& order = {});

  void set_zero();
  /// A_ij += block (d_i x d_j); of a pair i != j only one of both may be added, the other is its transpose.
  template <int I, int J>
  void add(int i, int j, const Eigen::Matrix<double, I, J>& block) {
    double* values = find_block(i, j);
    if (is_transposed(i, j)) {
      Eigen::Map<Eigen::Matrix<double, J, I>>(values) += block.transpose();
    } else {
      Eigen::Map<Eigen::Matrix<double, I, J>>(values) += block;
    }
  }
  /// False if A is not positive definite.
  bool factor();

  /// A^-1 b, with the variables in their own order, each at offset(i).
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
  std::size_t offset(int i) const { return pattern_.offset(i); }
  std::size_t size() const { return pattern_.size(); }

  /// Computes L^-1 H^T, where H^T has the listed blocks of variables of 6 numbers. The inner product of two
  /// of them is H_a A^-1 H_b^T.
  Sparse forward(std::span<const std::pair<int, Matrix6d>> H_transposed) const;
  static Matrix6d inner(const Sparse& a, const Sparse& b);

  /// Computes those blocks of A^-1 where L has any, in particular of all pairs of `variables` of the
  /// constructor (Takahashi's recursion), for at most twice what factor() takes.
  void invert(std::span<const int> variables);
  /// Block (i, j) of A^-1 for two of those variables, of 6 numbers, after invert(): none where L has no such
  /// block, zero where no factors connect the two.
  std::optional<Matrix6d> inverse_block(int i, int j) const;

 private:
  using Column = BlockPattern::Column;
  bool is_transposed(int i, int j) const { return pattern_.column_of(i) < pattern_.column_of(j); }
  double* find_block(int i, int j);
  /// x = L^-1 x and x = L^-T x, where the k-th eliminated variable is at x[at[k]].
  void solve_forward(const std::vector<std::size_t>& at, Eigen::VectorXd& x) const;
  void solve_backward(const std::vector<std::size_t>& at, Eigen::VectorXd& x) const;
  template <int J>
  void invert_column(const Column& column);

  BlockPattern pattern_;
  std::vector<double> values_;          ///< of A, then of L
  std::vector<std::uint8_t> zero_;      ///< by row of the pattern: L has no block there, since A has none
  std::vector<double> inverse_;         ///< where values_ has L
  std::vector<double> quotients_;       ///< of invert_column()
  mutable std::vector<Matrix6d> work_;  ///< of forward(), by column
  mutable std::vector<bool> reached_;
};

}  // namespace fleetmap::graph
