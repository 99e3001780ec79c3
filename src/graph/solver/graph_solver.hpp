#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "problem/estimate.hpp"
#include "solver/block_cholesky.hpp"

namespace fleetmap::graph {

/// Gauss-Newton steps after which a solve has not converged.
inline constexpr int kMaxSteps = 60;

/// Gauss-Newton on the reduced graph with a set of alignments.
class GraphSolver {
 public:
  using Ends = std::pair<std::size_t, std::size_t>;  ///< pose variables

  /// Alignments may be set between `pairs_to_align` only, so that the elimination is analysed once;
  /// relative_covariance() of these pairs is cheap. Without pairs the frames are chains, which are eliminated
  /// by cyclic reduction such that all covariances are cheap.
  GraphSolver(const ReducedGraph& graph, std::span<const Ends> pairs_to_align);

  /// The alignments of the next solve(). They must outlive it.
  void set_alignments(std::vector<const BetweenFactor*> alignments);

  enum class Outcome {
    converged,
    moving,  ///< finite, but not converged
    failed,  ///< the equations cannot be solved
  };
  /// Iterates until a step moves `estimate` by less than 0.1 mm, or `max_steps` times; a last step of less
  /// than 1 cm counts as converged too. The covariances below are those at the last factorisation, which is
  /// not repeated after small rotations.
  Outcome solve(Estimate& estimate, int max_steps);
  /// Makes the covariances those at `estimate`. False if they cannot be computed.
  bool factor_at(const Estimate& estimate);
  bool solved() const { return solved_; }

  /// L^-1 H^T of a relative pose between two pose variables, whose covariance is the inner product with
  /// itself.
  BlockCholesky::Sparse sensitivity(std::size_t a, std::size_t b, const Matrix6d& H_a,
                                    const Matrix6d& H_b) const;
  BlockCholesky::Sparse sensitivity(std::size_t pose) const;

  /// Prepares relative_covariance() between `poses` at the current solution.
  void invert(std::span<const int> poses) { cholesky_->invert(poses); }
  /// Covariance of H_a xi_a + xi_b.
  Matrix6d relative_covariance(std::size_t a, std::size_t b, const Matrix6d& H_a) const;

 private:
  struct StepSize {
    double max = 0.0, rotation = 0.0;  ///< m or rad; rad
  };
  /// Largest motion of any pose variable.
  StepSize size_of(const Eigen::VectorXd& step) const;
  void move(Estimate& estimate, const Eigen::VectorXd& step) const;
  void linearise(const Estimate& estimate);
  void add_relative(const Estimate& estimate, const BetweenFactor& between, bool robust);
  void add_window(const Estimate& estimate, std::size_t p);
  void add_drifts(const Estimate& estimate);
  int drift_variable(std::size_t p) const { return drift_variable_[p]; }
  auto part(int variable, int dim) {
    return right_.segment(static_cast<Eigen::Index>(cholesky_->offset(variable)), dim);
  }

  const ReducedGraph* graph_;
  std::vector<const BetweenFactor*> alignments_;
  std::vector<int> drift_variable_;  ///< by pose variable; -1 without a window
  std::vector<bool> first_drift_;    ///< by pose variable
  std::optional<BlockCholesky> cholesky_;
  Eigen::VectorXd right_;
  bool solved_ = false;
  bool factoring_ = true;  ///< the matrix is set up with the right side
  bool at_start_ = true;   ///< without Huber weights: far from the solution all residuals are large
};

}  // namespace fleetmap::graph
