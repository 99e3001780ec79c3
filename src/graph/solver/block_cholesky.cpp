#include "solver/block_cholesky.hpp"

#include <Eigen/Cholesky>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <type_traits>

#include "solver/block_kernels.hpp"

namespace fleetmap::graph {
namespace {

template <int R, int C>
using Block = Eigen::Map<Eigen::Matrix<double, R, C>>;
template <int R, int C>
using ConstBlock = Eigen::Map<const Eigen::Matrix<double, R, C>>;

/// Lower Cholesky factor in place; false if not positive definite.
template <int J>
bool factor_diagonal(double* values) {
  Block<J, J> A(values);
  const Eigen::LLT<Eigen::Matrix<double, J, J>> llt(A);
  if (llt.info() != Eigen::Success) return false;
  A = llt.matrixL();
  return A.allFinite();
}

/// L_ij = A_ij L_jj^-T.
template <int I, int J>
void divide(double* a, const double* l_jj) {
  Block<I, J> A(a);
  const ConstBlock<J, J> L(l_jj);
  for (int c = 0; c < J; ++c) {
    for (int k = 0; k < c; ++k) A.col(c) -= L(c, k) * A.col(k);
    A.col(c) /= L(c, c);
  }
}

void divide(int i, int j, double* a, const double* l_jj) {
  if (i == 6) {
    j == 6 ? divide<6, 6>(a, l_jj) : divide<6, 3>(a, l_jj);
  } else {
    j == 6 ? divide<3, 6>(a, l_jj) : divide<3, 3>(a, l_jj);
  }
}

/// Calls `run` with the dimension, 3 or 6, as a constant.
template <class Run>
void with_dim(int dim, const Run& run) {
  dim == 6 ? run(std::integral_constant<int, 6>()) : run(std::integral_constant<int, 3>());
}

/// x = L^-1 x and x = L^-T x, column by column.
template <int J, int C>
void solve_lower(const double* l, double* x) {
  const ConstBlock<J, J> L(l);
  for (int c = 0; c < C; ++c, x += J) {
    for (int k = 0; k < J; ++k) {
      x[k] /= L(k, k);
      for (int i = k + 1; i < J; ++i) x[i] -= L(i, k) * x[k];
    }
  }
}
template <int J, int C>
void solve_upper(const double* l, double* x) {
  const ConstBlock<J, J> L(l);
  for (int c = 0; c < C; ++c, x += J) {
    for (int k = J - 1; k >= 0; --k) {
      for (int i = k + 1; i < J; ++i) x[k] -= L(i, k) * x[i];
      x[k] /= L(k, k);
    }
  }
}

}  // namespace

BlockCholesky::BlockCholesky(std::vector<int> dims, const std::vector<std::pair<int, int>>& pairs,
                             const std::vector<int>& order)
    : dims_(std::move(dims)) {
  for (const int dim : dims_) {
    own_offset_.push_back(size_);
    size_ += static_cast<std::size_t>(dim);
  }
  to_column_.resize(dims_.size());
  if (order.empty()) {
    order_by_degree(pairs);
  } else {
    for (std::size_t k = 0; k < order.size(); ++k)
      to_column_[static_cast<std::size_t>(order[k])] = static_cast<int>(k);
  }
  analyse(pairs);
}

void BlockCholesky::order_by_degree(const std::vector<std::pair<int, int>>& pairs) {
  const int n = static_cast<int>(dims_.size());
  std::vector<Eigen::Triplet<double>> triplets;
  for (int i = 0; i < n; ++i) triplets.emplace_back(i, i, 1.0);
  for (const auto& [i, j] : pairs) {
    triplets.emplace_back(i, j, 1.0);
    triplets.emplace_back(j, i, 1.0);
  }
  Eigen::SparseMatrix<double> pattern(n, n);
  pattern.setFromTriplets(triplets.begin(), triplets.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(pattern, order);
  // order.indices()(k) is the variable that is eliminated as the k-th.
  for (int k = 0; k < n; ++k) to_column_[static_cast<std::size_t>(order.indices()(k))] = k;
}

void BlockCholesky::analyse(const std::vector<std::pair<int, int>>& pairs) {
  const int n = static_cast<int>(dims_.size());
  std::vector<std::vector<int>> below(dims_.size());
  for (const auto& [i, j] : pairs) {
    const int a = to_column_[static_cast<std::size_t>(i)], b = to_column_[static_cast<std::size_t>(j)];
    if (a != b) below[static_cast<std::size_t>(std::min(a, b))].push_back(std::max(a, b));
  }
  columns_.resize(dims_.size());
  for (int i = 0; i < n; ++i)
    columns_[static_cast<std::size_t>(to_column_[static_cast<std::size_t>(i)])].dim =
        dims_[static_cast<std::size_t>(i)];
  std::size_t values = 0;
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    Column& column = columns_[k];
    std::vector<int>& rows = below[k];
    std::ranges::sort(rows);
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    // What is left of this column after its elimination fills its parent's.
    if (rows.size() > 1) {
      std::vector<int>& parent = below[static_cast<std::size_t>(rows.front())];
      parent.insert(parent.end(), rows.begin() + 1, rows.end());
    }
    column.diagonal = values;
    values += static_cast<std::size_t>(column.dim * column.dim);
    column.first = rows_.size();
    for (const int row : rows) {
      rows_.push_back({row, values, false});
      values += static_cast<std::size_t>(column.dim * columns_[static_cast<std::size_t>(row)].dim);
    }
    column.end = rows_.size();
    rows = {};
  }
  values_.assign(values, 0.0);
  work_.resize(dims_.size());
  reached_.assign(dims_.size(), false);
}

void BlockCholesky::set_zero() { std::ranges::fill(values_, 0.0); }

std::optional<std::size_t> BlockCholesky::find(int row, int column) const {
  const Column& c = columns_[static_cast<std::size_t>(column)];
  if (row == column) return c.diagonal;
  const auto first = rows_.begin() + static_cast<std::ptrdiff_t>(c.first);
  const auto end = rows_.begin() + static_cast<std::ptrdiff_t>(c.end);
  const auto found =
      std::lower_bound(first, end, row, [](const Row& r, int wanted) { return r.row < wanted; });
  if (found == end || found->row != row) return std::nullopt;
  return found->at;
}

double* BlockCholesky::find_block(int i, int j) {
  const int a = to_column_[static_cast<std::size_t>(i)], b = to_column_[static_cast<std::size_t>(j)];
  return &values_[find(std::max(a, b), std::min(a, b)).value()];
}

bool BlockCholesky::factor() {
  const BlockKernels& kernels = block_kernels();
  for (const Column& column : columns_) {
    double* diagonal = &values_[column.diagonal];
    const bool definite = column.dim == 6 ? factor_diagonal<6>(diagonal) : factor_diagonal<3>(diagonal);
    if (!definite) return false;
    for (std::size_t r = column.first; r < column.end; ++r) {
      const int dim = columns_[static_cast<std::size_t>(rows_[r].row)].dim;
      double* block = &values_[rows_[r].at];
      rows_[r].zero = std::all_of(block, block + dim * column.dim, [](double v) { return v == 0.0; });
      if (!rows_[r].zero) divide(dim, column.dim, block, diagonal);
    }
    for (std::size_t k = column.first; k < column.end; ++k) {
      if (rows_[k].zero) continue;
      const Column& target = columns_[static_cast<std::size_t>(rows_[k].row)];
      const double* l_kj = &values_[rows_[k].at];
      kernels.subtraction(target.dim, target.dim, column.dim)(&values_[target.diagonal], l_kj, l_kj);
      std::size_t t = target.first;
      for (std::size_t i = k + 1; i < column.end; ++i) {
        if (rows_[i].zero) continue;
        while (rows_[t].row != rows_[i].row) ++t;
        const int dim_i = columns_[static_cast<std::size_t>(rows_[i].row)].dim;
        kernels.subtraction(dim_i, target.dim, column.dim)(&values_[rows_[t].at], &values_[rows_[i].at],
                                                           l_kj);
      }
    }
  }
  return true;
}

Eigen::VectorXd BlockCholesky::solve(const Eigen::VectorXd& b) const {
  std::vector<std::size_t> at(columns_.size());
  std::vector<Eigen::Index> own(columns_.size());
  std::size_t offset = 0;
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    at[k] = offset;
    offset += static_cast<std::size_t>(columns_[k].dim);
  }
  for (std::size_t i = 0; i < dims_.size(); ++i)
    own[static_cast<std::size_t>(to_column_[i])] = static_cast<Eigen::Index>(own_offset_[i]);
  const auto part = [&](Eigen::VectorXd& v, std::size_t k) {
    return v.segment(static_cast<Eigen::Index>(at[k]), columns_[k].dim);
  };
  Eigen::VectorXd x(static_cast<Eigen::Index>(size_));
  for (std::size_t k = 0; k < columns_.size(); ++k) part(x, k) = b.segment(own[k], columns_[k].dim);
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    const Column& c = columns_[k];
    with_dim(c.dim, [&]<int J>(std::integral_constant<int, J>) {
      solve_lower<J, 1>(&values_[c.diagonal], &x(static_cast<Eigen::Index>(at[k])));
      const Eigen::Matrix<double, J, 1> x_k = part(x, k);
      for (std::size_t r = c.first; r < c.end; ++r) {
        const auto row = static_cast<std::size_t>(rows_[r].row);
        with_dim(columns_[row].dim, [&]<int I>(std::integral_constant<int, I>) {
          Block<I, 1>(&x(static_cast<Eigen::Index>(at[row]))).noalias() -=
              ConstBlock<I, J>(&values_[rows_[r].at]).lazyProduct(x_k);
        });
      }
    });
  }
  for (std::size_t k = columns_.size(); k-- > 0;) {
    const Column& c = columns_[k];
    with_dim(c.dim, [&]<int J>(std::integral_constant<int, J>) {
      Eigen::Matrix<double, J, 1> x_k = part(x, k);
      for (std::size_t r = c.first; r < c.end; ++r) {
        const auto row = static_cast<std::size_t>(rows_[r].row);
        with_dim(columns_[row].dim, [&]<int I>(std::integral_constant<int, I>) {
          x_k.noalias() -= ConstBlock<I, J>(&values_[rows_[r].at])
                               .transpose()
                               .lazyProduct(ConstBlock<I, 1>(&x(static_cast<Eigen::Index>(at[row]))));
        });
      }
      solve_upper<J, 1>(&values_[c.diagonal], x_k.data());
      part(x, k) = x_k;
    });
  }
  Eigen::VectorXd result(static_cast<Eigen::Index>(size_));
  for (std::size_t k = 0; k < columns_.size(); ++k) result.segment(own[k], columns_[k].dim) = part(x, k);
  return result;
}

BlockCholesky::Sparse BlockCholesky::forward(std::span<const std::pair<int, Matrix6d>> H_transposed) const {
  // L^-1 of what starts at a column is not zero on its path to the root of the elimination tree alone.
  std::vector<int> reach;
  for (const auto& [variable, block] : H_transposed) {
    int k = to_column_[static_cast<std::size_t>(variable)];
    const int start = k;
    while (!reached_[static_cast<std::size_t>(k)]) {
      reached_[static_cast<std::size_t>(k)] = true;
      reach.push_back(k);
      work_[static_cast<std::size_t>(k)].setZero();
      const Column& c = columns_[static_cast<std::size_t>(k)];
      if (c.first == c.end) break;
      k = rows_[c.first].row;
    }
    work_[static_cast<std::size_t>(start)] += block;
  }
  std::ranges::sort(reach);
  Sparse result;
  result.reserve(reach.size());
  for (const int k : reach) {
    const Column& c = columns_[static_cast<std::size_t>(k)];
    Matrix6d& z = work_[static_cast<std::size_t>(k)];
    with_dim(c.dim, [&]<int J>(std::integral_constant<int, J>) {
      Eigen::Matrix<double, J, 6> z_k = z.topRows<J>();
      solve_lower<J, 6>(&values_[c.diagonal], z_k.data());
      for (std::size_t r = c.first; r < c.end; ++r) {
        if (rows_[r].zero) continue;
        const auto row = static_cast<std::size_t>(rows_[r].row);
        with_dim(columns_[row].dim, [&]<int I>(std::integral_constant<int, I>) {
          work_[row].template topRows<I>().noalias() -=
              ConstBlock<I, J>(&values_[rows_[r].at]).lazyProduct(z_k);
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
  std::vector<bool> wanted(columns_.size(), false);
  for (const int variable : variables) {
    int k = to_column_[static_cast<std::size_t>(variable)];
    while (!wanted[static_cast<std::size_t>(k)]) {
      wanted[static_cast<std::size_t>(k)] = true;
      const Column& c = columns_[static_cast<std::size_t>(k)];
      if (c.first == c.end) break;
      k = rows_[c.first].row;
    }
  }
  inverse_.resize(values_.size());
  for (std::size_t j = columns_.size(); j-- > 0;) {
    if (!wanted[j]) continue;
    const std::size_t end = j + 1 < columns_.size() ? columns_[j + 1].diagonal : values_.size();
    std::fill(inverse_.begin() + static_cast<std::ptrdiff_t>(columns_[j].diagonal),
              inverse_.begin() + static_cast<std::ptrdiff_t>(end), 0.0);
    with_dim(columns_[j].dim, [&]<int J>(std::integral_constant<int, J>) { invert_column<J>(columns_[j]); });
  }
}

template <int J>
void BlockCholesky::invert_column(const Column& c) {
  using Square = Eigen::Matrix<double, J, J>;
  const BlockKernels& kernels = block_kernels();
  Square L_inverse = Square::Identity();
  solve_lower<J, J>(&values_[c.diagonal], L_inverse.data());
  Square Z_jj = L_inverse.transpose() * L_inverse;
  quotients_.resize(36 * (c.end - c.first));
  // U_kj = L_kj L_jj^-1.
  const auto u = [&](std::size_t k) -> double* {
    return rows_[k].zero ? nullptr : &quotients_[rows_[k].at - rows_[c.first].at];
  };
  const auto dim = [&](std::size_t k) { return columns_[static_cast<std::size_t>(rows_[k].row)].dim; };
  for (std::size_t k = c.first; k < c.end; ++k) {
    if (rows_[k].zero) continue;
    with_dim(dim(k), [&]<int K>(std::integral_constant<int, K>) {
      Block<K, J>(u(k)).noalias() = ConstBlock<K, J>(&values_[rows_[k].at]).lazyProduct(L_inverse);
    });
  }
  for (std::size_t k = c.first; k < c.end; ++k) {
    const Column& column = columns_[static_cast<std::size_t>(rows_[k].row)];
    std::size_t t = column.first;
    for (std::size_t i = k + 1; i < c.end; ++i) {
      if (rows_[i].zero && rows_[k].zero) continue;
      while (rows_[t].row != rows_[i].row) ++t;
      kernels.subtraction_of_both(dim(i), column.dim, J)(&inverse_[rows_[t].at], u(k), u(i),
                                                         &inverse_[rows_[i].at], &inverse_[rows_[k].at]);
    }
    kernels.subtraction_of_both(column.dim, column.dim, J)(&inverse_[column.diagonal], u(k), nullptr,
                                                           &inverse_[rows_[k].at], nullptr);
  }
  for (std::size_t k = c.first; k < c.end; ++k) {
    if (rows_[k].zero) continue;
    with_dim(dim(k), [&]<int K>(std::integral_constant<int, K>) {
      Z_jj.noalias() -=
          ConstBlock<K, J>(u(k)).transpose().lazyProduct(ConstBlock<K, J>(&inverse_[rows_[k].at]));
    });
  }
  Block<J, J> diagonal(&inverse_[c.diagonal]);
  diagonal = 0.5 * (Z_jj + Z_jj.transpose());
}

int BlockCholesky::root(int column) const {
  for (const Column* c = &columns_[static_cast<std::size_t>(column)]; c->first != c->end;
       c = &columns_[static_cast<std::size_t>(column)])
    column = rows_[c->first].row;
  return column;
}

std::optional<Matrix6d> BlockCholesky::inverse_block(int i, int j) const {
  const int a = to_column_[static_cast<std::size_t>(i)], b = to_column_[static_cast<std::size_t>(j)];
  const std::optional<std::size_t> found = find(std::max(a, b), std::min(a, b));
  if (found) {
    const ConstBlock<6, 6> Z(&inverse_[*found]);
    return a >= b ? Matrix6d(Z) : Matrix6d(Z.transpose());
  }
  if (root(a) != root(b)) return Matrix6d(Matrix6d::Zero());
  return std::nullopt;
}

}  // namespace fleetmap::graph
