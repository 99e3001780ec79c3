#pragma once

#include <limits>

#include "rejection/candidate.hpp"

namespace fleetmap::graph {

/// Quantile of chi squared, six degrees of freedom, 1e-5: a candidate beyond it contradicts the graph.
inline constexpr double kInnovationGate = 33.1;

/// m, 1 sigma: a position of this certainty distinguishes neighbouring rows of a plant. A graph of this
/// certainty decides about single candidates.
inline constexpr double kCertainM = 1.2;

/// Innovation of a measured relative pose: its deviation from the one that a solved graph predicts.
struct Innovation {
  double distance = 0.0;  ///< squared Mahalanobis distance, six degrees of freedom
  double sigma_m = std::numeric_limits<double>::infinity();  ///< m, of the prediction, along its worst axis
  /// -2 log likelihood without its constant: `distance` and the log det of the innovation's covariance, which
  /// makes measurements of large covariance less likely.
  double cost = 0.0;
};

/// C_ij times four and a floor, because registration underestimates its errors. The gates use it; a smaller
/// one would separate alignments that agree.
Matrix6d inflated_covariance(const BetweenFactor& factor);

/// Innovation of `factor`, which is not part of the solved graph. Needs solver.invert().
Innovation innovation(const BetweenFactor& factor, const SolvedGraph& solved);

/// Innovation of `factor`, which is part of the solved graph, against the rest of it (leave one out).
/// Distance 0 where the rest does not determine the relative pose. Needs solver.invert().
Innovation innovation_without(const BetweenFactor& factor, const SolvedGraph& solved);

}  // namespace fleetmap::graph
