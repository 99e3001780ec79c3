#include "fleetmap/planning/mission/mission_complete.hpp"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <vector>

#include "fleetmap/core/text_list.hpp"

namespace fleetmap::planning {
namespace {

std::size_t root_of(std::vector<std::size_t>& parent, std::size_t k) {
  while (parent[k] != k) k = parent[k] = parent[parent[k]];
  return k;
}

}  // namespace

Completeness mapping_complete(std::span<const AgentId> agents, std::span<const PairAlignment> alignments,
                              bool all_nodes_shared, double max_rmse) {
  if (agents.empty()) return {false, "no agents"};
  std::vector<std::size_t> parent(agents.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  for (const PairAlignment& pair : alignments) {
    const auto a = std::ranges::find(agents, pair.a);
    const auto b = std::ranges::find(agents, pair.b);
    if (a == agents.end() || b == agents.end() || !(pair.rmse >= 0.0 && pair.rmse <= max_rmse)) continue;
    parent[root_of(parent, static_cast<std::size_t>(a - agents.begin()))] =
        root_of(parent, static_cast<std::size_t>(b - agents.begin()));
  }
  std::string apart;
  for (std::size_t k = 1; k < agents.size(); ++k) {
    if (root_of(parent, k) != root_of(parent, 0)) append_to_list(apart, agents[k].str());
  }
  if (!apart.empty()) {
    char limit[32];
    std::snprintf(limit, sizeof limit, "%g m", max_rmse);
    return {false, "not yet aligned with " + agents[0].str() + " (E <= " + limit + "): " + apart};
  }
  if (!all_nodes_shared) return {false, "nodes are not yet the same on all agents"};
  return {true, ""};
}

}  // namespace fleetmap::planning
