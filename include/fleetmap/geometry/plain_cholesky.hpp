#pragma once

#include <cmath>

/// Cholesky factorisation in plain loops, whose operations come in the same order on every processor. Those
/// of Eigen are fused on ARM and cut into pieces by the size of the caches. Matrices are dense, column by
/// column, n x n; only lower triangles are read. `n` is best a constant.
namespace fleetmap::plain_cholesky {

/// A = L L^T in place; the upper triangle stays as it was. False if A is not positive definite; NaN is not.
[[gnu::always_inline]] inline bool factor(double* a, int n) {
  for (int k = 0; k < n; ++k) {
    double* const column = a + k * n;
    if (!(column[k] > 0.0)) return false;
    column[k] = std::sqrt(column[k]);
    for (int i = k + 1; i < n; ++i) column[i] /= column[k];
    for (int j = k + 1; j < n; ++j) {
      double* const later = a + j * n;
      for (int i = j; i < n; ++i) later[i] -= column[i] * column[j];
    }
  }
  return true;
}

/// X = L^-1 X for `columns` columns.
[[gnu::always_inline]] inline void solve_lower(const double* l, int n, double* x, int columns) {
  for (int c = 0; c < columns; ++c, x += n) {
    for (int k = 0; k < n; ++k) {
      x[k] /= l[k * n + k];
      for (int i = k + 1; i < n; ++i) x[i] -= l[k * n + i] * x[k];
    }
  }
}

/// X = L^-T X for `columns` columns.
[[gnu::always_inline]] inline void solve_upper(const double* l, int n, double* x, int columns) {
  for (int c = 0; c < columns; ++c, x += n) {
    for (int k = n - 1; k >= 0; --k) {
      for (int i = k + 1; i < n; ++i) x[k] -= l[k * n + i] * x[i];
      x[k] /= l[k * n + k];
    }
  }
}

}  // namespace fleetmap::plain_cholesky
