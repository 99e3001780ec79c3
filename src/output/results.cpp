#include "fleetmap/output/results.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <map>
#include <utility>

#include "corrected_pose.hpp"
#include "fleetmap/graph/frame_name.hpp"
#include "fleetmap/graph/located_nodes.hpp"
#include "fleetmap/output/global_track.hpp"
#include "fleetmap/output/map_comments.hpp"
#include "fleetmap/output/map_recipe.hpp"
#include "fleetmap/output/placed_store.hpp"
#include "fleetmap/output/trajectory_file.hpp"
#include "fleetmap/store/sessions.hpp"
#include "tables.hpp"

namespace fleetmap::output {
namespace {

/// Own nodes of one odometry frame that are placed, by time.
std::vector<CorrectedNode> corrected_nodes(const store::Store& store, const graph::Placement& placement,
                                           const graph::FrameId& frame) {
  std::vector<CorrectedNode> nodes;
  for (const auto& [id, node] : store.nodes()) {
    const auto placed = placement.T_enu_node.find(id);
    if (node.frame() != frame || placed == placement.T_enu_node.end()) continue;
    nodes.push_back({node.stamp, node.T_odom_base, placed->second});
  }
  std::ranges::stable_sort(nodes, {}, &CorrectedNode::stamp);
  return nodes;
}

/// Every session's odometry, moved along with its nodes.
Status write_trajectory(const store::Store& store, const graph::Placement& placement,
                        const ResultsConfig& config) {
  const Result<store::Sessions> sessions = store::Sessions::load(store);
  if (!sessions) return tl::unexpected(sessions.error());
  std::map<std::size_t, std::pair<graph::FrameId, Pose>> frames;  // in the order in which they began
  for (const auto& [frame, T_enu_odom] : placement.T_enu_odom) {
    if (frame.agent != config.agent) continue;
    if (const auto index = sessions->index_of(frame.session)) {
      frames.emplace(*index, std::pair(frame, T_enu_odom));
    } else {
      spdlog::warn(
          "{}: no odometry file of it is here (its nodes came back after the store was lost, or were given "
          "other names); it is left out of trajectory.tum",
          to_string(frame));
    }
  }
  Trajectory trajectory;
  for (const auto& [index, placed] : frames) {
    const auto& [frame, T_enu_odom] = placed;
    const auto odometry = read_growing_tum(odometry_file(config.directory, index));
    if (!odometry) {
      spdlog::warn("{}; left out of trajectory.tum", odometry.error().message);
      continue;
    }
    const std::vector<CorrectedNode> nodes = corrected_nodes(store, placement, frame);
    for (const StampedPose& pose : *odometry)
      trajectory.push_back({pose.stamp, corrected_pose(nodes, T_enu_odom, pose)});
  }
  return write_tum(config.directory / "trajectory.tum", trajectory);
}

Status write_global_poses(const LocalFrame& site, const ResultsConfig& config) {
  const auto track = read_global_track(config.directory / "global_track.csv");
  if (!track) return tl::unexpected(track.error());
  Trajectory poses;
  for (const GlobalPose& G : *track) poses.push_back({G.stamp, pose_in(site, G)});
  return write_tum(config.directory / "ekf.tum", poses);
}

}  // namespace

Result<Results> write_results(store::Store& store, const ResultsConfig& config,
                              std::span<const MapFiles> others, const store::SubmapLoader& load) {
  const std::optional<GeoPoint> origin = site_origin(store, config.recipe.site_origin);
  if (!origin) {
    return failure(config.agent.str() +
                   ": there is no map to write: no node was made or received; did GPS and LiDAR arrive?");
  }
  Results results;
  results.origin = *origin;
  if (const Status kept = keep_recipe(store, config.recipe); !kept) return tl::unexpected(kept.error());
  results.placement = place(store, *origin, config.recipe.placement);
  results.not_georeferenced = graph::not_georeferenced(nodes_of(store), results.placement.components);
  results.contradicting =
      graph::contradict_the_fleet(results.placement, nodes_of(store), LocalFrame(results.origin));
  MapParts parts = map_parts(nodes_of(store), results.placement);
  results.apart = std::move(parts.apart);
  const store::MergeConfig& merge = config.recipe.map;
  auto map = write_map(store, parts.main.T_map_node, merge, config.directory, others,
                       map_comments(store, parts.main, *origin, merge), load);
  if (!map) return tl::unexpected(map.error());
  results.map = std::move(*map);
  results.missing_submaps = store.nodes().size() - results.map.submaps;
  remove_parts(config.directory);
  for (const MapPart& part : results.apart) {
    const Result<std::size_t> submaps =
        write_part(store, part, merge, config.directory, map_comments(store, part, *origin, merge), load);
    if (!submaps) return tl::unexpected(submaps.error());
    results.missing_submaps -= *submaps;
  }
  const LocalFrame site(*origin);
  for (const Status& written :
       {write_trajectory(store, results.placement, config), write_global_poses(site, config),
        write_alignments(store, results.placement, config.directory / "alignments.csv"),
        write_nodes(store, results.placement, site, config.directory / "nodes.csv")}) {
    if (!written) return tl::unexpected(written.error());
  }
  return results;
}

}  // namespace fleetmap::output
