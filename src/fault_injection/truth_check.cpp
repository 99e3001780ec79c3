#include "truth_check.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <vector>

#include "fleetmap/graph/compute_placement.hpp"

namespace fleetmap::fault_injection {
namespace {

/// The placement of what no compromised robot made or computed.
graph::Placement honest_placement(const TruthInput& input) {
  std::vector<graph::Node> nodes;
  std::vector<graph::Alignment> alignments;
  std::ranges::copy_if(input.nodes, std::back_inserter(nodes),
                       [&](const graph::Node& node) { return node.id.agent != input.compromised; });
  std::ranges::copy_if(input.alignments, std::back_inserter(alignments), [&](const graph::Alignment& one) {
    return one.i.agent != input.compromised && one.j.agent != input.compromised &&
           one.computed_by != input.compromised;
  });
  return graph::compute_placement(nodes, alignments, input.site, {});
}

/// The largest difference of two displacements between the placements, within each component.
void find_torn(const graph::Placement& placement, const graph::Placement& honest, TruthErrors& errors) {
  for (const auto& component : honest.components) {
    const std::set<graph::FrameId> frames(component.begin(), component.end());
    std::optional<std::pair<NodeId, Eigen::Vector3d>> first;
    for (const auto& [id, T_enu] : honest.T_enu_node) {
      const auto placed = placement.T_enu_node.find(id);
      if (placed == placement.T_enu_node.end() || !frames.contains({id.agent, session_of(id.seq)})) continue;
      const Eigen::Vector3d moved = placed->second.translation() - T_enu.translation();
      if (!first) first = {id, moved};
      if (const double torn = (moved - first->second).norm(); torn > errors.torn) {
        errors.torn = torn;
        errors.torn_a = first->first;
        errors.torn_b = id;
      }
    }
  }
}

}  // namespace

TruthErrors truth_errors(const graph::Placement& placement, const TruthInput& input) {
  TruthErrors errors;
  for (const auto& [id, T_enu] : placement.T_enu_node) {
    const Pose* truth = id.agent == input.compromised ? nullptr : input.truth(id);
    if (truth == nullptr) continue;
    const double error = (T_enu.translation() - truth->translation()).norm();
    if (error <= errors.largest) continue;
    errors.largest = error;
    errors.worst = id;
  }
  if (input.compromised) find_torn(placement, honest_placement(input), errors);
  return errors;
}

}  // namespace fleetmap::fault_injection
