#pragma once

#include <Eigen/Core>
#include <type_traits>

#include "fleetmap/geometry/plain_cholesky.hpp"

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

/// Lower Cholesky factor in place, zero above; false if the block is not positive definite.
template <int J>
bool factor_diagonal(double* values) {
  if (!plain_cholesky::factor(values, J)) return false;
  Block<J, J> A(values);
  A.template triangularView<Eigen::StrictlyUpper>().setZero();
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

}  // namespace fleetmap::graph
