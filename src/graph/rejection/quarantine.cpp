#include "rejection/quarantine.hpp"

#include <algorithm>
#include <vector>

namespace fleetmap::graph {
namespace {

constexpr double kSameSetM = 1.5;
constexpr std::size_t kMaxSetsPerOther = 2;
constexpr std::size_t kMinSets = 4;
constexpr std::size_t kMinSetsPerAccepted = 2;

/// Translation in ENU of the second frame against the first, by which the candidate deviates from the
/// estimate.
Eigen::Vector3d deviation(const Candidate& candidate, const Estimate& estimate) {
  const BetweenFactor& factor = candidate.factor;
  const RelativeResidual r = relative_residual(estimate, factor.a, factor.b, factor.T_a_b);
  return -candidate.sign * (estimate.T_enu[factor.b].linear() * r.e.head<3>());
}

}  // namespace

std::map<AgentId, std::size_t> outlier_sets(const ReducedGraph& graph, std::span<const Candidate> candidates,
                                            const std::map<std::size_t, AlignmentStatus>& statuses,
                                            std::span<const AgentId> computed_by, const Estimate& estimate) {
  std::map<std::pair<FramePair, AgentId>, std::vector<Eigen::Vector3d>> sets;  // each by its first deviation
  std::map<AgentId, std::map<AgentId, std::size_t>> by_other;
  std::set<std::size_t> counted;  // alignments
  for (const Candidate& candidate : candidates) {
    const auto status = statuses.find(candidate.alignment);
    if (status == statuses.end() || status->second == AlignmentStatus::undecided ||
        !counted.insert(candidate.alignment).second)
      continue;
    const AgentId& by = computed_by[candidate.alignment];
    std::vector<Eigen::Vector3d>& of_pair = sets[{candidate.frames, by}];
    const Eigen::Vector3d d = deviation(candidate, estimate);
    if (std::ranges::any_of(of_pair, [&](const auto& other) { return (other - d).norm() < kSameSetM; }))
      continue;
    of_pair.push_back(d);
    const AgentId& first = graph.frames[candidate.frames.first].id.agent;
    const AgentId& second = graph.frames[candidate.frames.second].id.agent;
    ++by_other[by][by == first ? second : first];
  }
  std::map<AgentId, std::size_t> counts;
  for (const auto& [agent, others] : by_other)
    for (const auto& [other, count] : others) counts[agent] += std::min(count, kMaxSetsPerOther);
  return counts;
}

std::set<AgentId> to_quarantine(const std::map<AgentId, std::size_t>& outlier_sets,
                                const std::map<AgentId, std::size_t>& accepted) {
  std::set<AgentId> agents;
  for (const auto& [agent, sets] : outlier_sets) {
    const auto of_agent = accepted.find(agent);
    const std::size_t good = of_agent == accepted.end() ? 0 : of_agent->second;
    if (sets >= kMinSets && sets >= kMinSetsPerAccepted * good) agents.insert(agent);
  }
  return agents;
}

}  // namespace fleetmap::graph
