#pragma once

#include <limits>

#include "solver/graph_solver.hpp"

namespace fleetmap::graph {

/// Quantile of chi squared, six degrees of freedom, 1e-5: beyond it a candidate contradicts what is expected.
inline constexpr double kInnovationGate = 33.1;

/// m, 1 sigma: what knows a place better tells rows apart. A graph that does decides about a single
/// candidate.
inline constexpr double kCertainM = 1.2;

/// What a graph expects of a relative pose that was measured between two of its poses.
struct Innovation {
  double distance = 0.0;  ///< squared Mahalanobis distance of what was measured from what is expected
  double sigma_m = std::numeric_limits<double>::infinity();  ///< how well the graph knows, in the worst axis
  /// -2 log likelihood of what was measured, less a constant: `distance`, and log det of the covariance that
  /// it is judged by. What says little fits anywhere, and is no likelier for it.
  double cost = 0.0;
};

/// Covariance of a registration's error as candidates are judged by it.
Matrix6d inflated_covariance(const BetweenFactor& between);

/// Of a solved graph in which `between` is no tie. Needs solver.invert().
Innovation innovation(const BetweenFactor& between, const GraphSolver& solver, const Estimate& estimate);

/// Of the rest of a solved graph in which `between` is a tie. Distance 0 where the rest knows nothing.
Innovation innovation_without(const BetweenFactor& between, const GraphSolver& solver,
                              const Estimate& estimate);

}  // namespace fleetmap::graph
