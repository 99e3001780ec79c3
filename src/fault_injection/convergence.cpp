#include "convergence.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "fleetmap/graph/compute_placement.hpp"
#include "fleetmap/output/placed_store.hpp"
#include "fleetmap/store/map_merge.hpp"
#include "synthetic_survey.hpp"

namespace fleetmap::fault_injection {
namespace {

/// The first item that one of the two sets lacks, and which: " r1#7/3 less" or " r1#7/3 more".
std::string difference(const store::SeqSet& set, const store::SeqSet& first) {
  for (const auto& [lacking, word] :
       {std::pair(first.minus(set), " less"), std::pair(set.minus(first), " more")}) {
    if (lacking.empty()) continue;
    return std::string(" ").append(to_string(NodeId{lacking[0].agent, lacking[0].first})).append(word);
  }
  return "";
}

}  // namespace

std::string why_not_converged(const Robots& robots, Stamp now) {
  const store::Store& first = *robots.begin()->second.store;
  for (const auto& [name, robot] : robots) {
    const store::Store& store = *robot.store;
    if (!(store.node_set() == first.node_set()))
      return name.str() + " holds other nodes:" + difference(store.node_set(), first.node_set());
    if (!(store.alignment_set() == first.alignment_set()))
      return name.str() +
             " holds other alignments:" + difference(store.alignment_set(), first.alignment_set());
    if (!(store.submap_set() == first.submap_set()))
      return name.str() + " holds other submaps:" + difference(store.submap_set(), first.submap_set());
    for (const SeqRange& range : first.node_set().ranges()) {
      if (store.node_print(range) != first.node_print(range))
        return name.str() + " holds another content of a node of " + range.agent.str();
    }
    for (const SeqRange& range : first.alignment_set().ranges()) {
      if (store.alignment_print(range) != first.alignment_print(range))
        return name.str() + " holds another content of an alignment of " + range.agent.str();
    }
    if (!robot.exchange->fleet_caught_up()) return name.str() + " finds that another lacks something";
    if (!robot.exchange->idle(now + robot.clock_offset)) return name.str() + " is not idle";
  }
  return "";
}

std::string why_incomplete(const Robots& robots, Stamp now) {
  for (const auto& [name, robot] : robots) {
    if (!robot.exchange->complete()) return name.str() + " finds that it lacks something";
    // A meeting ends only then.
    if (robot.exchange->in_sync_with(now + robot.clock_offset).size() + 1 < robots.size())
      return name.str() + " finds that another holds other submaps";
  }
  return "";
}

graph::Placement placement_of(const ExchangeFleet::Robot& robot, const LocalFrame& site) {
  return graph::compute_placement(output::nodes_of(*robot.store), output::alignments_of(*robot.store), site,
                                  {});
}

std::vector<MapDifference> map_differences(const Robots& robots, const LocalFrame& site) {
  std::vector<MapDifference> differences;
  std::optional<graph::Placement> first;
  std::optional<store::MergedMap> first_map;
  for (const auto& [name, robot] : robots) {
    graph::Placement placement = placement_of(robot, site);
    const auto load = [&store = *robot.store](const NodeId& id) -> Result<cloud::PointCloud> {
      const auto bytes = store.submap(id);
      if (!bytes) return tl::unexpected(bytes.error());
      return SyntheticSurvey::decode_submap(*bytes);
    };
    store::MergedMap map = store::merge(placement.T_enu_node, load, {});
    if (!first) {
      first = std::move(placement);
      first_map = std::move(map);
      continue;
    }
    const bool same_placement =
        std::ranges::equal(placement.T_enu_node, first->T_enu_node, [](const auto& a, const auto& b) {
          return a.first == b.first && a.second.matrix() == b.second.matrix();
        });
    if (!same_placement) differences.push_back({name, "other places"});
    if (map.cloud.points != first_map->cloud.points || map.unreadable != first_map->unreadable)
      differences.push_back({name, "other points"});
  }
  return differences;
}

}  // namespace fleetmap::fault_injection
