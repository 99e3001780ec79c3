#include "fleetmap/geometry/symmetric.hpp"

#include <Eigen/Eigenvalues>

#include "fleetmap/geometry/plain_cholesky.hpp"
#include "fleetmap/geometry/portable_math.hpp"

namespace fleetmap {

SymmetricEigen eigen_of_symmetric(const Matrix6d& A) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

CholeskyOf::CholeskyOf(const Matrix6d& A) : L_(A), positive_definite_(plain_cholesky::factor(L_.data(), 6)) {}

Matrix6d CholeskyOf::inverse() const {
  Matrix6d inverse = Matrix6d::Identity();
  plain_cholesky::solve_lower(L_.data(), 6, inverse.data(), 6);
  plain_cholesky::solve_upper(L_.data(), 6, inverse.data(), 6);
  return inverse;
}

Vector6d CholeskyOf::solve(const Vector6d& e) const {
  Vector6d x = e;
  plain_cholesky::solve_lower(L_.data(), 6, x.data(), 1);
  plain_cholesky::solve_upper(L_.data(), 6, x.data(), 1);
  return x;
}

double CholeskyOf::squared_distance(const Vector6d& e) const {
  Vector6d x = e;
  plain_cholesky::solve_lower(L_.data(), 6, x.data(), 1);
  return x.squaredNorm();
}

double CholeskyOf::log_det() const {
  double sum = 0.0;
  for (Eigen::Index k = 0; k < 6; ++k) sum += portable::log(L_(k, k));
  return 2.0 * sum;
}

}  // namespace fleetmap
