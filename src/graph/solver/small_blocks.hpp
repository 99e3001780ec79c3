#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <type_traits>

/// Dense operations on the 3 x 3 to 6 x 6 blocks of BlockCholesky, column by column in memory.
namespace fleetmap::graph {

template <int R, int C>
using Block = Eigen::Map<Eigen::Matrix<double, R, C>>;
template <int R, int C>
using ConstBlock = Eigen::Map<const Eigen::Matrix<double, R, C>>;

/// Calls `run` with the dimension, 3 or 6, as a constant.
template <class Run>
void with_dim(int dim, const Run& run) {
  dim == 6 ? run(std::integral_constant<int, 6>()) : run(std::integral_constant<int, 3>());
}

/// Lower Cholesky factor in place; false if the block is not positive definite.
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

inline void divide(int i, int j, double* a, const double* l_jj) {
  if (i == 6) {
    j == 6 ? divide<6, 6>(a, l_jj) : divide<6, 3>(a, l_jj);
  } else {
    j == 6 ? divide<3, 6>(a, l_jj) : divide<3, 3>(a, l_jj);
  }
}

/// x = L^-1 x, column by column.
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

/// x = L^-T x, column by column.
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

}  // namespace fleetmap::graph
