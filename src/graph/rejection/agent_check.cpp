#include "rejection/agent_check.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "rejection/joint_hypotheses.hpp"

namespace fleetmap::graph {
namespace {

constexpr std::size_t kMaxHypotheses = 32;  ///< bounds the cost
constexpr std::size_t kMinPeers = 2;

using Ends = std::pair<AgentId, AgentId>;

struct BestHypotheses {
  std::vector<Hypothesis> all;
  std::vector<Ends> ends;  ///< agents of each

  bool concerns(std::size_t k, const AgentId& agent) const {
    return ends[k].first == agent || ends[k].second == agent;
  }
  const AgentId& other(std::size_t k, const AgentId& agent) const {
    return ends[k].first == agent ? ends[k].second : ends[k].first;
  }
};

/// Between different agents, those of most evidence first.
BestHypotheses best_hypotheses(const RejectionProblem& problem, const PriorEvidence& evidence) {
  BestHypotheses best;
  for (const auto& [frames, sets] : evidence.sets) {
    const AgentId &a = problem.graph.frames[frames.first].id.agent,
                  &b = problem.graph.frames[frames.second].id.agent;
    if (a == b) continue;
    if (auto hypothesis = clear_best(sets, {})) best.all.push_back(std::move(*hypothesis));
  }
  std::ranges::stable_sort(best.all, std::ranges::greater(), &Hypothesis::evidence);
  best.all.resize(std::min(best.all.size(), kMaxHypotheses));
  for (const Hypothesis& one : best.all)
    best.ends.emplace_back(problem.graph.frames[one.frames.first].id.agent,
                           problem.graph.frames[one.frames.second].id.agent);
  return best;
}

/// Peers of the agent by hypotheses that agree with those of all others, accepted in order of evidence.
std::size_t agreeing_peers(const AgentId& agent, const BestHypotheses& best, const JointHypotheses& joint) {
  Indices kept = joint.select([&](std::size_t k) { return !best.concerns(k, agent); });
  std::set<AgentId> peers;
  for (std::size_t k = 0; k < joint.size(); ++k) {
    if (!best.concerns(k, agent)) continue;
    kept.push_back(k);
    if (joint.are_consistent(kept)) {
      peers.insert(best.other(k, agent));
    } else {
      kept.pop_back();
    }
  }
  return peers.size();
}

}  // namespace

std::optional<AgentId> contradicting_agent(const RejectionProblem& problem, const PriorEvidence& evidence,
                                           const SolvedGraph& prior) {
  const BestHypotheses best = best_hypotheses(problem, evidence);
  if (best.all.size() <= kMinPeers) return {};
  const JointHypotheses joint(problem.candidates, best.all, prior, 1);
  if (joint.are_consistent(joint.select([](std::size_t) { return true; }))) return {};
  for (std::size_t one = 0; one < joint.size(); ++one)
    if (joint.are_consistent(joint.select([&](std::size_t k) { return k != one; }))) return {};
  std::map<AgentId, std::set<AgentId>> peers;
  for (const auto& [a, b] : best.ends) {
    peers[a].insert(b);
    peers[b].insert(a);
  }
  std::optional<AgentId> found;
  for (const auto& entry : peers) {
    const auto& [agent, others] = entry;
    const auto without = joint.select([&](std::size_t k) { return !best.concerns(k, entry.first); });
    if (others.size() < kMinPeers || !joint.are_consistent(without)) continue;
    if (found) return {};
    found = agent;
  }
  if (!found || 2 * agreeing_peers(*found, best, joint) > peers[*found].size()) return {};
  return found;
}

}  // namespace fleetmap::graph
