#include "fleetmap/geometry/symmetric.hpp"

#include <Eigen/Eigenvalues>

namespace fleetmap {

SymmetricEigen eigen_of_symmetric(const Matrix6d& A) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

CholeskyOf::CholeskyOf(const Matrix6d& A) : llt_(A) {}

Matrix6d CholeskyOf::inverse() const { return llt_.solve(Matrix6d::Identity()); }

double CholeskyOf::squared_distance(const Vector6d& e) const { return e.dot(llt_.solve(e)); }

double CholeskyOf::log_det() const {
  return 2.0 * llt_.matrixL().toDenseMatrix().diagonal().array().log().sum();
}

}  // namespace fleetmap
