#pragma once

#include <span>
#include <vector>

#include "rejection/hypothesis.hpp"

namespace fleetmap::graph {

/// Hypotheses of several frame pairs, linearised together at the prior, each by some of its members: joint
/// compatibility (Neira and Tardos, IEEE T-RA 17(6), 2001) of sets instead of single measurements.
class JointHypotheses {
 public:
  JointHypotheses(std::span<const Candidate> all, std::span<const Hypothesis> hypotheses,
                  const SolvedGraph& prior, std::size_t max_members);

  std::size_t size() const { return members_.size(); }
  /// Squared Mahalanobis distance to the prior of some of them together, three degrees of freedom each.
  double distance(std::span<const std::size_t> some) const;
  /// Some of them can be right together: within the 1e-5 quantile of chi squared.
  bool are_consistent(std::span<const std::size_t> some) const;
  /// The indices of all for which `keep` is true.
  template <class Keep>
  Indices select(const Keep& keep) const {
    Indices some;
    for (std::size_t k = 0; k < size(); ++k)
      if (keep(k)) some.push_back(k);
    return some;
  }

 private:
  std::vector<LinearisedCandidate> candidates_;
  std::vector<Indices> members_;  ///< of each hypothesis, in `candidates_`
  CrossCovariances cross_;
};

/// Quantile of chi squared, 1e-5, within 5.3 % (Wilson and Hilferty 1931). Boost.Math's is exact, but calls
/// the C library's functions, whose last digit differs between x86 and ARM: two robots could then place the
/// same items differently. This has a square root and products alone.
double rare_chi_squared(double degrees_of_freedom);

}  // namespace fleetmap::graph
