#pragma once

#include "fleetmap/geometry/se3.hpp"

namespace fleetmap {

// Decompositions of covariances and information matrices, compiled once, because each costs the compiler
// seconds in every file that instantiates it.

/// Eigenvalues and eigenvectors of a symmetric 6x6 matrix.
struct SymmetricEigen {
  Vector6d values;   ///< ascending
  Matrix6d vectors;  ///< columns, orthonormal
};

/// Decomposes a symmetric matrix; only its lower triangle is read.
SymmetricEigen eigen_of_symmetric(const Matrix6d& A);

/// A = L L^T, the same bits on every processor. Where A is not positive definite, what it answers is not to
/// be used and may not be finite.
class CholeskyOf {
 public:
  explicit CholeskyOf(const Matrix6d& A);

  bool positive_definite() const { return positive_definite_; }
  Matrix6d inverse() const;
  Vector6d solve(const Vector6d& e) const;  ///< A^-1 e
  /// e^T A^-1 e: of a covariance, the squared Mahalanobis distance.
  double squared_distance(const Vector6d& e) const;
  double log_det() const;

 private:
  Matrix6d L_;  ///< its lower triangle
  bool positive_definite_;
};

}  // namespace fleetmap
