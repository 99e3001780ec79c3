#include "fleetmap/graph/contradictions.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "fleetmap/core/text_list.hpp"

namespace fleetmap::graph {
namespace {

constexpr std::size_t kMinRejected = 3;  ///< alignments of a pair of agents
constexpr std::size_t kMinContradictingPeers = 2;
constexpr std::size_t kMinSteps = 4;
/// Bounds of a step's difference between fixes and odometry. GPS in the field may jump by some metres.
constexpr double kStepSigmas = 6.0;
constexpr double kStepFloorM = 5.0;
constexpr double kMaxSpeed = 10.0;  ///< m/s

using AgentPair = std::pair<AgentId, AgentId>;

struct Counts {
  std::size_t used = 0, rejected = 0;
};

bool is_rejected(AlignmentStatus status) {
  return status == AlignmentStatus::against_gps || status == AlignmentStatus::against_others ||
         status == AlignmentStatus::quarantined;
}

/// Rejected alignments of each pair of agents most of whose alignments are rejected.
std::map<AgentPair, std::size_t> disputes(const Placement& placement) {
  std::map<AgentPair, Counts> counts;
  for (const AlignmentOutcome& one : placement.outcomes) {
    if (one.i.agent == one.j.agent) continue;
    Counts& of_pair = counts[std::minmax(one.i.agent, one.j.agent)];
    of_pair.used += one.status == AlignmentStatus::used;
    of_pair.rejected += is_rejected(one.status);
  }
  std::map<AgentPair, std::size_t> found;
  for (const auto& [pair, count] : counts)
    if (count.rejected >= kMinRejected && count.rejected > count.used) found.emplace(pair, count.rejected);
  return found;
}

std::map<AgentId, Contradiction> parties(const std::map<AgentPair, std::size_t>& disputes) {
  std::map<AgentId, Contradiction> found;
  for (const auto& [pair, rejected] : disputes) {
    for (const auto& [agent, other] : {pair, AgentPair(pair.second, pair.first)}) {
      found[agent].alignments += rejected;
      found[agent].with.insert(other);
    }
  }
  return found;
}

/// The agent that the placement leaves out, with all whom it was aligned with.
void add_left_out(const AgentId& agent, const Placement& placement, std::map<AgentId, Contradiction>& found) {
  Contradiction& left_out = found[agent] = {};
  for (const AlignmentOutcome& one : placement.outcomes) {
    if (one.i.agent == one.j.agent || (one.i.agent != agent && one.j.agent != agent)) continue;
    ++left_out.alignments;
    left_out.with.insert(one.i.agent == agent ? one.j.agent : one.i.agent);
  }
}

/// True if the fixes of two successive nodes of a frame contradict the odometry between them, or if this is
/// faster than any ground robot.
bool contradicts_itself(const Node& a, const Node& b, const LocalFrame& site) {
  const double by_odometry = (b.T_odom_base.translation() - a.T_odom_base.translation()).norm();
  if (by_odometry > kStepFloorM + kMaxSpeed * std::abs(to_seconds(b.stamp - a.stamp))) return true;
  if (!a.G || !b.G) return false;
  const double by_fixes = (site.to_enu(b.G->position) - site.to_enu(a.G->position)).norm();
  const double variance = a.G->covariance.diagonal().head<3>().sum() +
                          b.G->covariance.diagonal().head<3>().sum() +
                          b.odom_covariance.diagonal().head<3>().sum();
  return std::abs(by_fixes - by_odometry) > kStepFloorM + kStepSigmas * std::sqrt(variance);
}

void add_steps(std::span<const Node> nodes, const LocalFrame& site, std::map<AgentId, Contradiction>& found) {
  std::map<AgentId, std::pair<std::size_t, std::size_t>> steps;  // contradicting, all
  std::map<FrameId, const Node*> last;
  for (const Node& node : nodes) {
    const Node*& before = last[node.frame()];
    if (before != nullptr) {
      auto& [contradicting, all] = steps[node.id.agent];
      contradicting += contradicts_itself(*before, node, site);
      ++all;
    }
    before = &node;
  }
  for (const auto& [agent, count] : steps)
    if (count.first >= kMinSteps && 4 * count.first > count.second) found[agent].steps = count.first;
}

}  // namespace

std::string to_string(const Contradiction& contradiction) {
  std::string text;
  const auto add = [&text](std::size_t count, const std::string& what) {
    if (count > 0) append_to_list(text, std::to_string(count) + what, "; ");
  };
  std::string names;
  for (const AgentId& agent : contradiction.with) append_to_list(names, agent.str());
  add(contradiction.alignments, " alignments with " + names + " are rejected");
  add(contradiction.steps, " steps of its odometry are impossible or contradict its fixes");
  add(contradiction.impossible, " of its items have impossible numbers");
  return text;
}

std::map<AgentId, Contradiction> contradict_the_fleet(const Placement& placement, std::span<const Node> nodes,
                                                      const LocalFrame& site) {
  std::map<AgentId, Contradiction> found;
  for (auto left = disputes(placement); !left.empty();) {
    const auto by_agent = parties(left);
    const auto worst = std::ranges::max_element(by_agent, {}, [](const auto& one) {
      return std::pair(one.second.with.size(), one.second.alignments);
    });
    if (worst->second.with.size() < kMinContradictingPeers) break;
    found.insert(*worst);
    std::erase_if(left, [&](const auto& one) {
      return one.first.first == worst->first || one.first.second == worst->first;
    });
  }
  if (placement.contradicting) add_left_out(*placement.contradicting, placement, found);
  add_steps(nodes, site, found);
  for (const Node& node : nodes)
    if (!placement.T_enu_node.contains(node.id)) ++found[node.id.agent].impossible;
  for (const AlignmentOutcome& one : placement.outcomes)
    if (one.status == AlignmentStatus::invalid) ++found[one.computed_by].impossible;
  return found;
}

}  // namespace fleetmap::graph
