#pragma once

#include <map>
#include <set>
#include <span>
#include <vector>

#include "rejection/pairwise_consistency.hpp"

namespace fleetmap::graph {

/// What GPS and odometry say of all candidates, before any is taken.
struct JudgedAlone {
  std::map<FramePair, std::vector<std::size_t>> groups;  ///< candidates, but for the hopeless
  std::map<FramePair, Evaluation> hypotheses;
  std::set<std::size_t> against_gps;  ///< candidates that contradict
  std::set<std::size_t> together;     ///< of these, what contradicts as a whole, though not one by one
  std::set<std::size_t> hopeless;     ///< of these, what is not looked at again
  std::set<std::size_t> outvoted;     ///< candidates that their neighbours contradict
};

/// `solver` is without any candidate, solved, and ready for relative_covariance() between their ends.
JudgedAlone judge_alone(std::span<const Candidate> candidates, const GraphSolver& solver,
                        const Estimate& estimate);

}  // namespace fleetmap::graph
