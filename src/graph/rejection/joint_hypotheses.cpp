#include "rejection/joint_hypotheses.hpp"

#include <cmath>

namespace fleetmap::graph {

double rare_chi_squared(double degrees_of_freedom) {
  constexpr double kNormalQuantile = 4.2649;  // of 1e-5
  const double variance = 2.0 / (9.0 * degrees_of_freedom);
  const double root = 1.0 - variance + kNormalQuantile * std::sqrt(variance);
  return degrees_of_freedom * root * root * root;
}

JointHypotheses::JointHypotheses(std::span<const Candidate> all, std::span<const Hypothesis> hypotheses,
                                 const SolvedGraph& prior, std::size_t max_members) {
  for (const Hypothesis& hypothesis : hypotheses) {
    members_.emplace_back();
    for (const std::size_t c : evenly_spaced(hypothesis.members, max_members)) {
      members_.back().push_back(candidates_.size());
      candidates_.push_back(linearise(all, c, prior));
    }
  }
  cross_ = cross_covariances(candidates_);
}

double JointHypotheses::distance(std::span<const std::size_t> some) const {
  std::vector<Indices> members;
  for (const std::size_t k : some) members.push_back(members_[k]);
  return members.empty() ? 0.0 : squared_distance_to_prior(members, candidates_, cross_);
}

bool JointHypotheses::are_consistent(std::span<const std::size_t> some) const {
  return some.empty() || distance(some) < rare_chi_squared(3.0 * static_cast<double>(some.size()));
}

}  // namespace fleetmap::graph
