#pragma once

#include <span>
#include <vector>

#include "rejection/candidate.hpp"

namespace fleetmap::graph {

/// A candidate linearised at a solved graph: its residual e is drawn from N(0, S) if the candidate is right.
struct LinearisedCandidate {
  std::size_t candidate = 0;
  std::size_t alignment = 0;
  Vector6d e;
  BlockCholesky::Sparse z;  ///< GraphSolver::sensitivity(); inner products are covariances
  Matrix6d S;               ///< of e: of the graph's prediction and of the registration
  Matrix6d S_inverse;
  double cost = 0.0;              ///< -2 log likelihood of e, without its constant
  Eigen::Matrix<double, 6, 3> B;  ///< derivative of e by a translation of the second frame in ENU
};

LinearisedCandidate linearise(std::span<const Candidate> all, std::size_t index, const SolvedGraph& solved);
std::vector<LinearisedCandidate> linearise(std::span<const Candidate> all,
                                           std::span<const std::size_t> indices, const SolvedGraph& solved);

/// Cov(e_a, e_b) of candidates a and b: [a][b] for b < a.
using CrossCovariances = std::vector<std::vector<Matrix6d>>;
CrossCovariances cross_covariances(std::span<const LinearisedCandidate> candidates);

/// The residual of one candidate conditioned on another one being right.
struct ConditionalResidual {
  double distance = 0.0;  ///< squared Mahalanobis distance, six degrees of freedom
  double cost = 0.0;      ///< -2 log likelihood, without its constant
  double sigma_m = 0.0;   ///< m, of the conditional distribution along its worst axis
  /// The two are pairwise consistent (PCM): within the 1e-4 quantile of chi squared.
  bool is_consistent() const;
};
/// Conditional distribution of `b` given `a`. `S_ba` is Cov(e_b, e_a).
ConditionalResidual conditional_residual(const LinearisedCandidate& a, const LinearisedCandidate& b,
                                         const Matrix6d& S_ba);

/// Pose variable of the candidate's end in its first frame, which orders candidates of two frames along the
/// track, whichever of the two robots computed them.
std::size_t position_on_track(const Candidate& candidate);

/// Up to `count` of the indices, evenly spaced.
Indices evenly_spaced(std::span<const std::size_t> indices, std::size_t count);

}  // namespace fleetmap::graph
