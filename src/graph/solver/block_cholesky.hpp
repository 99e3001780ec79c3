#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::graph {

/// Cholesky factorisation A = L L^T of a sparse symmetric positive definite matrix made of small dense
/// blocks: variables of 6 or 3 numbers. Same input, same bits.
class BlockCholesky {
 public:
  /// L^-1 H of six columns, by column of L in ascending order: only what is not zero. Of variables of 3
  /// numbers the lower rows are zero.
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
  std::size_t offset(int i) const { return own_offset_[static_cast<std::size_t>(i)]; }
  std::size_t size() const { return size_; }

  /// L^-1 H^T for H^T given by blocks of variables of 6. The inner product of two of them is H_a A^-1 H_b^T.
  Sparse forward(std::span<const std::pair<int, Matrix6d>> H_transposed) const;
  static Matrix6d inner(const Sparse& a, const Sparse& b);

  /// Computes those blocks of A^-1 where L has any, in particular of all pairs of `variables` of the
  /// constructor (Takahashi's recursion), for at most twice what factor() takes.
  void invert(std::span<const int> variables);
  /// Block (i, j) of A^-1 for two of those variables, of 6 numbers, after invert(): none where L has no such
  /// block, zero where no factors connect the two.
  std::optional<Matrix6d> inverse_block(int i, int j) const;

 private:
  struct Column {
    int dim = 0;
    std::size_t diagonal = 0;  ///< in values_
    std::size_t first = 0;     ///< of its rows, in rows_
    std::size_t end = 0;
  };
  struct Row {
    int row = 0;
    std::size_t at = 0;  ///< in values_
    bool zero = false;   ///< of L: pairs of the constructor to which nothing was added
  };
  void order_by_degree(const std::vector<std::pair<int, int>>& pairs);
  void analyse(const std::vector<std::pair<int, int>>& pairs);
  bool is_transposed(int i, int j) const {
    return to_column_[static_cast<std::size_t>(i)] < to_column_[static_cast<std::size_t>(j)];
  }
  double* find_block(int i, int j);
  std::optional<std::size_t> find(int row, int column) const;
  int root(int column) const;
  template <int J>
  void invert_column(const Column& column);

  std::vector<int> dims_;  ///< by own index
  std::vector<int> to_column_;
  std::vector<std::size_t> own_offset_;
  std::size_t size_ = 0;
  std::vector<Column> columns_;
  std::vector<Row> rows_;  ///< below the diagonal, column by column, ascending
  std::vector<double> values_;
  std::vector<double> inverse_;         ///< where values_ has L
  std::vector<double> quotients_;       ///< of invert_column()
  mutable std::vector<Matrix6d> work_;  ///< of forward(), by column
  mutable std::vector<bool> reached_;
};

}  // namespace fleetmap::graph
