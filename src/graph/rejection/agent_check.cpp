#include "rejection/agent_check.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <vector>

#include "rejection/joint_hypotheses.hpp"

namespace fleetmap::graph {
namespace {

constexpr std::size_t kMaxHypotheses = 32;  ///< bounds the cost
constexpr std::size_t kMinContradictedPeers = 2;

constexpr double kMeanDistance = 3.0;  ///< squared Mahalanobis distance of a right hypothesis: its dimensions
constexpr double kMinDifference = 13.8;  ///< of squared distances: a thousand times as likely

using Peers = std::map<AgentId, std::set<AgentId>>;
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

Peers peers_of(const BestHypotheses& best) {
  Peers peers;
  for (const auto& [a, b] : best.ends) {
    peers[a].insert(b);
    peers[b].insert(a);
  }
  return peers;
}

/// Squared distance of the hypotheses for which `keep` is true, if they are consistent. Those that are left
/// out count as much as right ones do in the mean.
template <class Keep>
std::optional<double> distance_of(const JointHypotheses& joint, const Keep& keep) {
  const auto kept = joint.select(keep);
  if (!joint.are_consistent(kept)) return {};
  return joint.distance(kept) + kMeanDistance * static_cast<double>(joint.size() - kept.size());
}

/// The least of distance_of() with one hypothesis left out.
double distance_without_one(const JointHypotheses& joint) {
  double min_distance = std::numeric_limits<double>::infinity();
  for (std::size_t one = 0; one < joint.size(); ++one)
    min_distance = std::min(
        min_distance, distance_of(joint, [&](std::size_t k) { return k != one; }).value_or(min_distance));
  return min_distance;
}

/// The agent without whose hypotheses the rest is consistent, and by far the likeliest explanation. There may
/// be others: of a compromised robot, the only honest one that it did not displace along.
std::optional<AgentId> likeliest_cause(const BestHypotheses& best, const JointHypotheses& joint,
                                       const Peers& peers) {
  std::optional<AgentId> found;
  double min_distance = std::numeric_limits<double>::infinity(), second = distance_without_one(joint);
  for (const auto& entry : peers) {
    if (entry.second.size() < kMinContradictedPeers) continue;
    const auto distance = distance_of(joint, [&](std::size_t k) { return !best.concerns(k, entry.first); });
    if (!distance) continue;
    second = std::min(second, std::max(min_distance, *distance));
    if (*distance < min_distance) {
      min_distance = *distance;
      found = entry.first;
    }
  }
  if (second - min_distance < kMinDifference) return {};
  return found;
}

}  // namespace

std::optional<AgentId> contradicting_agent(const RejectionProblem& problem, const PriorEvidence& evidence,
                                           const SolvedGraph& prior) {
  const BestHypotheses best = best_hypotheses(problem, evidence);
  if (best.all.size() <= kMinContradictedPeers) return {};
  const JointHypotheses joint(problem.candidates, best.all, prior, 1);
  if (joint.are_consistent(joint.select([](std::size_t) { return true; }))) return {};
  const Peers peers = peers_of(best);
  const auto found = likeliest_cause(best, joint, peers);
  if (!found || 2 * agreeing_peers(*found, best, joint) > peers.at(*found).size()) return {};
  return found;
}

}  // namespace fleetmap::graph
