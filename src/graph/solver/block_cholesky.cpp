#include "solver/block_cholesky.hpp"

#include <algorithm>

#include "solver/block_kernels.hpp"
#include "solver/small_blocks.hpp"

namespace fleetmap::graph {

BlockCholesky::BlockCholesky(std::vector<int> dims, const std::vector<std::pair<int, int>>& pairs,
                             const std::vector<int>& order)
    : pattern_(std::move(dims), pairs, order),
      values_(pattern_.values(), 0.0),
      zero_(pattern_.rows().size(), 0),
      work_(pattern_.variables()),
      reached_(pattern_.variables(), false) {}

void BlockCholesky::set_zero() { std::ranges::fill(values_, 0.0); }

double* BlockCholesky::find_block(int i, int j) {
  const int a = pattern_.column_of(i), b = pattern_.column_of(j);
  return &values_[pattern_.find(std::max(a, b), std::min(a, b)).value()];
}

bool BlockCholesky::factor() {
  const BlockKernels& kernels = block_kernels();
  const std::vector<BlockPattern::Row>& rows = pattern_.rows();
  for (const Column& column : pattern_.columns()) {
    double* diagonal = &values_[column.diagonal];
    const bool definite = column.dim == 6 ? factor_diagonal<6>(diagonal) : factor_diagonal<3>(diagonal);
    if (!definite) return false;
    for (std::size_t r = column.first; r < column.end; ++r) {
      const int dim = pattern_.column(rows[r].row).dim;
      double* block = &values_[rows[r].at];
      zero_[r] = std::all_of(block, block + dim * column.dim, [](double v) { return v == 0.0; }) ? 1 : 0;
      if (!zero_[r]) divide(dim, column.dim, block, diagonal);
    }
    for (std::size_t k = column.first; k < column.end; ++k) {
      if (zero_[k]) continue;
      const Column& target = pattern_.column(rows[k].row);
      const double* l_kj = &values_[rows[k].at];
      kernels.subtraction(target.dim, target.dim, column.dim)(&values_[target.diagonal], l_kj, l_kj);
      std::size_t t = target.first;
      for (std::size_t i = k + 1; i < column.end; ++i) {
        if (zero_[i]) continue;
        while (rows[t].row != rows[i].row) ++t;
        const int dim_i = pattern_.column(rows[i].row).dim;
        kernels.subtraction(dim_i, target.dim, column.dim)(&values_[rows[t].at], &values_[rows[i].at], l_kj);
      }
    }
  }
  return true;
}

Eigen::VectorXd BlockCholesky::solve(const Eigen::VectorXd& b) const {
  std::vector<std::size_t> at(pattern_.variables());
  std::size_t offset = 0;
  for (std::size_t k = 0; k < at.size(); ++k) {
    at[k] = offset;
    offset += static_cast<std::size_t>(pattern_.columns()[k].dim);
  }
  // Copies each variable between its place in the caller's order and that in elimination order.
  const auto for_each_part = [&](const auto& copy) {
    for (std::size_t i = 0; i < pattern_.variables(); ++i) {
      const auto k = static_cast<std::size_t>(pattern_.column_of(static_cast<int>(i)));
      copy(static_cast<Eigen::Index>(pattern_.offset(static_cast<int>(i))), static_cast<Eigen::Index>(at[k]),
           pattern_.columns()[k].dim);
    }
  };
  Eigen::VectorXd x(b.size()), result(b.size());
  for_each_part(
      [&](auto own, auto eliminated, int dim) { x.segment(eliminated, dim) = b.segment(own, dim); });
  solve_forward(at, x);
  solve_backward(at, x);
  for_each_part(
      [&](auto own, auto eliminated, int dim) { result.segment(own, dim) = x.segment(eliminated, dim); });
  return result;
}

void BlockCholesky::solve_forward(const std::vector<std::size_t>& at, Eigen::VectorXd& x) const {
  const std::vector<BlockPattern::Row>& rows = pattern_.rows();
  for (std::size_t k = 0; k < at.size(); ++k) {
    const Column& c = pattern_.columns()[k];
    with_dim(c.dim, [&]<int J>(std::integral_constant<int, J>) {
      plain_cholesky::solve_lower(&values_[c.diagonal], J, &x(static_cast<Eigen::Index>(at[k])), 1);
      const Eigen::Matrix<double, J, 1> x_k = Block<J, 1>(&x(static_cast<Eigen::Index>(at[k])));
      for (std::size_t r = c.first; r < c.end; ++r) {
        with_dim(pattern_.column(rows[r].row).dim, [&]<int I>(std::integral_constant<int, I>) {
          Block<I, 1>(&x(static_cast<Eigen::Index>(at[static_cast<std::size_t>(rows[r].row)]))).noalias() -=
              ConstBlock<I, J>(&values_[rows[r].at]).lazyProduct(x_k);
        });
      }
    });
  }
}

void BlockCholesky::solve_backward(const std::vector<std::size_t>& at, Eigen::VectorXd& x) const {
  const std::vector<BlockPattern::Row>& rows = pattern_.rows();
  for (std::size_t k = at.size(); k-- > 0;) {
    const Column& c = pattern_.columns()[k];
    with_dim(c.dim, [&]<int J>(std::integral_constant<int, J>) {
      Eigen::Matrix<double, J, 1> x_k = Block<J, 1>(&x(static_cast<Eigen::Index>(at[k])));
      for (std::size_t r = c.first; r < c.end; ++r) {
        with_dim(pattern_.column(rows[r].row).dim, [&]<int I>(std::integral_constant<int, I>) {
          const double* x_r = &x(static_cast<Eigen::Index>(at[static_cast<std::size_t>(rows[r].row)]));
          x_k.noalias() -=
              ConstBlock<I, J>(&values_[rows[r].at]).transpose().lazyProduct(ConstBlock<I, 1>(x_r));
        });
      }
      plain_cholesky::solve_upper(&values_[c.diagonal], J, x_k.data(), 1);
      Block<J, 1>(&x(static_cast<Eigen::Index>(at[k]))) = x_k;
    });
  }
}

BlockCholesky::Sparse BlockCholesky::forward(std::span<const std::pair<int, Matrix6d>> H_transposed) const {
  const std::vector<BlockPattern::Row>& rows = pattern_.rows();
  // L^-1 times a block in one column is zero except in the rows on the path from that column to the root of
  // the elimination tree.
  std::vector<int> reach;
  for (const auto& [variable, block] : H_transposed) {
    const int start = pattern_.column_of(variable);
    for (int k = start; k >= 0 && !reached_[static_cast<std::size_t>(k)]; k = pattern_.parent(k)) {
      reached_[static_cast<std::size_t>(k)] = true;
      reach.push_back(k);
      work_[static_cast<std::size_t>(k)].setZero();
    }
    work_[static_cast<std::size_t>(start)] += block;
  }
  std::ranges::sort(reach);
  Sparse result;
  result.reserve(reach.size());
  for (const int k : reach) {
    const Column& c = pattern_.column(k);
    Matrix6d& z = work_[static_cast<std::size_t>(k)];
    with_dim(c.dim, [&]<int J>(std::integral_constant<int, J>) {
      Eigen::Matrix<double, J, 6> z_k = z.topRows<J>();
      plain_cholesky::solve_lower(&values_[c.diagonal], J, z_k.data(), 6);
      for (std::size_t r = c.first; r < c.end; ++r) {
        if (zero_[r]) continue;
        const auto row = static_cast<std::size_t>(rows[r].row);
        with_dim(pattern_.columns()[row].dim, [&]<int I>(std::integral_constant<int, I>) {
          work_[row].template topRows<I>().noalias() -=
              ConstBlock<I, J>(&values_[rows[r].at]).lazyProduct(z_k);
        });
      }
      z.topRows<J>() = z_k;
    });
    result.emplace_back(k, z);
    reached_[static_cast<std::size_t>(k)] = false;
  }
  return result;
}

Matrix6d BlockCholesky::inner(const Sparse& a, const Sparse& b) {
  Matrix6d sum = Matrix6d::Zero();
  auto at_b = b.begin();
  for (const auto& [column, z_a] : a) {
    while (at_b != b.end() && at_b->first < column) ++at_b;
    if (at_b == b.end()) break;
    if (at_b->first == column) sum.noalias() += z_a.transpose().lazyProduct(at_b->second);
  }
  return sum;
}

void BlockCholesky::invert(std::span<const int> variables) {
  // A column of the inverse follows from those on its path to the root of the elimination tree.
  std::vector<bool> wanted(pattern_.variables(), false);
  for (const int variable : variables) {
    for (int k = pattern_.column_of(variable); k >= 0 && !wanted[static_cast<std::size_t>(k)];
         k = pattern_.parent(k))
      wanted[static_cast<std::size_t>(k)] = true;
  }
  inverse_.resize(values_.size());
  const std::vector<Column>& columns = pattern_.columns();
  for (std::size_t j = columns.size(); j-- > 0;) {
    if (!wanted[j]) continue;
    const std::size_t end = j + 1 < columns.size() ? columns[j + 1].diagonal : values_.size();
    std::fill(inverse_.begin() + static_cast<std::ptrdiff_t>(columns[j].diagonal),
              inverse_.begin() + static_cast<std::ptrdiff_t>(end), 0.0);
    with_dim(columns[j].dim, [&]<int J>(std::integral_constant<int, J>) { invert_column<J>(columns[j]); });
  }
}

template <int J>
void BlockCholesky::invert_column(const Column& c) {
  using Square = Eigen::Matrix<double, J, J>;
  const BlockKernels& kernels = block_kernels();
  const std::vector<BlockPattern::Row>& rows = pattern_.rows();
  Square L_inverse = Square::Identity();
  plain_cholesky::solve_lower(&values_[c.diagonal], J, L_inverse.data(), J);
  Square Z_jj = L_inverse.transpose() * L_inverse;
  quotients_.resize(36 * (c.end - c.first));
  // U_kj = L_kj L_jj^-1.
  const auto u = [&](std::size_t k) -> double* {
    return zero_[k] ? nullptr : &quotients_[rows[k].at - rows[c.first].at];
  };
  const auto dim = [&](std::size_t k) { return pattern_.column(rows[k].row).dim; };
  for (std::size_t k = c.first; k < c.end; ++k) {
    if (zero_[k]) continue;
    with_dim(dim(k), [&]<int K>(std::integral_constant<int, K>) {
      Block<K, J>(u(k)).noalias() = ConstBlock<K, J>(&values_[rows[k].at]).lazyProduct(L_inverse);
    });
  }
  for (std::size_t k = c.first; k < c.end; ++k) {
    const Column& column = pattern_.column(rows[k].row);
    std::size_t t = column.first;
    for (std::size_t i = k + 1; i < c.end; ++i) {
      if (zero_[i] && zero_[k]) continue;
      while (rows[t].row != rows[i].row) ++t;
      kernels.subtraction_of_both(dim(i), column.dim, J)(&inverse_[rows[t].at], u(k), u(i),
                                                         &inverse_[rows[i].at], &inverse_[rows[k].at]);
    }
    kernels.subtraction_of_both(column.dim, column.dim, J)(&inverse_[column.diagonal], u(k), nullptr,
                                                           &inverse_[rows[k].at], nullptr);
  }
  for (std::size_t k = c.first; k < c.end; ++k) {
    if (zero_[k]) continue;
    with_dim(dim(k), [&]<int K>(std::integral_constant<int, K>) {
      Z_jj.noalias() -=
          ConstBlock<K, J>(u(k)).transpose().lazyProduct(ConstBlock<K, J>(&inverse_[rows[k].at]));
    });
  }
  Block<J, J> diagonal(&inverse_[c.diagonal]);
  diagonal = 0.5 * (Z_jj + Z_jj.transpose());
}

std::optional<Matrix6d> BlockCholesky::inverse_block(int i, int j) const {
  const int a = pattern_.column_of(i), b = pattern_.column_of(j);
  const std::optional<std::size_t> found = pattern_.find(std::max(a, b), std::min(a, b));
  if (found) {
    const ConstBlock<6, 6> Z(&inverse_[*found]);
    return a >= b ? Matrix6d(Z) : Matrix6d(Z.transpose());
  }
  if (pattern_.root(a) != pattern_.root(b)) return Matrix6d(Matrix6d::Zero());
  return std::nullopt;
}

}  // namespace fleetmap::graph
