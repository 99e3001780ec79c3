#pragma once

#include <Eigen/Cholesky>

#include "fleetmap/geometry/se3.hpp"

namespace fleetmap {

// Decompositions of covariances and information matrices, compiled once, because each costs the compiler
// seconds in every file that instantiates it.

struct SymmetricEigen {
  Vector6d values;   ///< ascending
  Matrix6d vectors;  ///< columns, orthonormal
};

/// Decomposes a symmetric matrix; only its lower triangle is read.
SymmetricEigen eigen_of_symmetric(const Matrix6d& A);

/// A = L L^T. Where A is not positive definite, what it answers is not to be used and may not be finite.
class CholeskyOf {
 public:
  explicit CholeskyOf(const Matrix6d& A);

  bool positive_definite() const { return llt_.info() == Eigen::Success; }
  Matrix6d inverse() const;
  /// e^T A^-1 e: of a covariance, the squared Mahalanobis distance.
  double squared_distance(const Vector6d& e) const;
  double log_det() const;

 private:
  Eigen::LLT<Matrix6d> llt_;
};

}  // namespace fleetmap
