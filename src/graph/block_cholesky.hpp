#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <utility>
#include <vector>

#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::graph {

/// Cholesky factorisation A = L L^T of a sparse symmetric positive definite matrix made of small dense
/// blocks: variables of 6 or 3 numbers. Same input, same bits.
class BlockCholesky {
 public:
  /// A block of a right side with six columns, or of what the forward solution makes of it.
  using Columns = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::ColMajor, 6, 6>;
  /// L^-1 H, by column of L in ascending order: only what is not zero.
  using Sparse = std::vector<std::pair<int, Columns>>;

  /// `dims` of the variables (3 or 6), and the pairs of variables that share a factor. They are eliminated in
  /// `order`, or in one that keeps L sparse if it is empty.
  BlockCholesky(std::vector<int> dims, const std::vector<std::pair<int, int>>& pairs,
                const std::vector<int>& order = {});

  void set_zero();
  /// A_ij += block (d_i x d_j); of a pair i != j only one of both may be given, the other is its transpose.
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

  /// L^-1 H^T for H^T given by blocks of variables. The inner product of two of them is H_a A^-1 H_b^T.
  Sparse forward(const std::vector<std::pair<int, Columns>>& H_transposed) const;
  static Matrix6d inner(const Sparse& a, const Sparse& b);

  std::size_t blocks() const { return rows_.size(); }

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
  };
  void order_by_degree(const std::vector<std::pair<int, int>>& pairs);
  void analyse(const std::vector<std::pair<int, int>>& pairs);
  bool is_transposed(int i, int j) const {
    return to_column_[static_cast<std::size_t>(i)] < to_column_[static_cast<std::size_t>(j)];
  }
  double* find_block(int i, int j);
  double* find(int row, int column);

  std::vector<int> dims_;  ///< by own index
  std::vector<int> to_column_;
  std::vector<std::size_t> own_offset_;
  std::size_t size_ = 0;
  std::vector<Column> columns_;
  std::vector<Row> rows_;  ///< below the diagonal, column by column, ascending
  std::vector<double> values_;
  mutable std::vector<Columns> work_;  ///< of forward(), by column
  mutable std::vector<bool> reached_;
};

}  // namespace fleetmap::graph
