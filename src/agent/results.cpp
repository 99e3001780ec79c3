#include "fleetmap/agent/results.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <numbers>
#include <vector>

#include "fleetmap/agent/corrected_pose.hpp"
#include "fleetmap/agent/global_track.hpp"
#include "fleetmap/agent/trajectory_file.hpp"
#include "fleetmap/graph/located_nodes.hpp"

namespace fleetmap::agent {
namespace {

constexpr const char* kRecipeKey = "map_recipe";
using StoredRecipe = std::array<double, 13>;

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
                        const AgentConfig& config) {
  const Result<Sessions> sessions = Sessions::load(store);
  if (!sessions) return tl::unexpected(sessions.error());
  std::map<std::size_t, std::pair<graph::FrameId, Pose>> frames;  // in the order in which they began
  for (const auto& [frame, T_enu_odom] : placement.T_enu_odom) {
    if (frame.agent != config.id) continue;
    if (const auto index = sessions->index_of(frame.session)) {
      frames.emplace(*index, std::pair(frame, T_enu_odom));
    } else {
      spdlog::warn(
          "{}: no odometry file of it is here (its nodes came back after the store was lost, or were given "
          "other names); it is left out of trajectory.tum",
          to_string(frame));
    }
  }
  std::vector<StampedPose> trajectory;
  for (const auto& [index, placed] : frames) {
    const auto& [frame, T_enu_odom] = placed;
    const auto odometry = read_trajectory(odometry_file(config.directory, index));
    if (!odometry) {
      spdlog::warn("{}; left out of trajectory.tum", odometry.error().message);
      continue;
    }
    const std::vector<CorrectedNode> nodes = corrected_nodes(store, placement, frame);
    for (const StampedPose& pose : *odometry)
      trajectory.push_back({pose.stamp, corrected_pose(nodes, T_enu_odom, pose)});
  }
  return write_trajectory(config.directory / "trajectory.tum", trajectory);
}

Status write_global_poses(const LocalFrame& site, const AgentConfig& config) {
  const auto track = read_global_track(config.directory / "global_track.csv");
  if (!track) return tl::unexpected(track.error());
  std::vector<StampedPose> poses;
  for (const GlobalPose& G : *track) poses.push_back({G.stamp, pose_in(site, G)});
  return write_trajectory(config.directory / "ekf.tum", poses);
}

/// A pose as seven columns: x, y, z, qx, qy, qz, qw.
std::ostream& write_pose(std::ostream& out, const Pose& T) {
  const Eigen::Quaterniond q(T.linear());
  const Eigen::Vector3d t = T.translation();
  return out << t.x() << ',' << t.y() << ',' << t.z() << ',' << q.x() << ',' << q.y() << ',' << q.z() << ','
             << q.w();
}

/// What became of each alignment, by name, and the mode that was taken, if any. Mode `paper` tells only what
/// it used.
struct Fate {
  std::string judgement;
  std::optional<std::size_t> mode;
};
std::map<std::pair<AgentId, std::uint32_t>, Fate> fates(const graph::Placement& placement) {
  std::map<std::pair<AgentId, std::uint32_t>, Fate> fates;
  for (const graph::Alignment& used : placement.used)
    fates[{used.computed_by, used.seq}] = {graph::to_string(graph::AlignmentStatus::used), 0};
  for (const graph::AlignmentOutcome& one : placement.outcomes) {
    Fate& fate = fates[{one.computed_by, one.seq}];
    fate.judgement = graph::to_string(one.status);
    if (one.status == graph::AlignmentStatus::used) fate.mode = one.mode;
  }
  return fates;
}

/// Every alignment held, a line for each of its modes.
Status write_alignments(const store::Store& store, const graph::Placement& placement,
                        const AgentConfig& config) {
  const std::filesystem::path file = config.directory / "alignments.csv";
  std::ofstream out(file, std::ios::trunc);
  out.precision(9);
  out << "i,j,computed_by,seq,mode,x,y,z,qx,qy,qz,qw,rmse_m,inlier_fraction,score,used,judgement";
  for (int k = 0; k < 6; ++k) out << ",var_" << k;
  out << '\n';
  const auto judged = fates(placement);
  for (const auto& [id, a] : store.alignments()) {
    const auto known = judged.find({a.computed_by, a.seq});
    const Fate fate = known == judged.end() ? Fate{} : known->second;
    for (std::size_t m = 0; m < a.modes.size(); ++m) {
      const graph::AlignmentMode& mode = a.modes[m];
      out << to_string(a.i) << ',' << to_string(a.j) << ',' << a.computed_by.str() << ',' << a.seq << ',' << m
          << ',';
      write_pose(out, mode.T_i_j) << ',' << mode.rmse << ',' << mode.inlier_fraction << ',' << mode.score
                                  << ',' << (fate.mode == m ? 1 : 0) << ',' << fate.judgement;
      for (int k = 0; k < 6; ++k) out << ',' << mode.covariance(k, k);
      out << '\n';
    }
  }
  out.flush();
  if (!out) return failure(file.string() + ": cannot be written; is the disk full?");
  return {};
}

/// G as fourteen columns, empty where there is none.
std::ostream& write_fix(std::ostream& out, const std::optional<GlobalPose>& G, const LocalFrame& site) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  if (!G) return out << ",,,,,,,,,,,,,";
  out << G->position.latitude * kDegrees << ',' << G->position.longitude * kDegrees << ','
      << G->position.altitude << ',';
  write_pose(out, pose_in(site, *G));
  for (const int k : {0, 1, 2}) out << ',' << std::sqrt(G->covariance(k, k));
  return out << ',' << std::sqrt(G->covariance(5, 5)) * kDegrees;
}

/// Every node held, by robot and number: O, G (also in ENU, with its sigmas), and where it is placed.
Status write_nodes(const store::Store& store, const graph::Placement& placement, const LocalFrame& site,
                   const std::filesystem::path& file) {
  std::ofstream out(file, std::ios::trunc);
  out.precision(12);
  out << "agent,seq,session,stamp_ns,odom_x,odom_y,odom_z,odom_qx,odom_qy,odom_qz,odom_qw,"
         "latitude_deg,longitude_deg,altitude_m,G_x,G_y,G_z,G_qx,G_qy,G_qz,G_qw,"
         "sigma_e_m,sigma_n_m,sigma_u_m,sigma_yaw_deg,submap_bytes,"
         "enu_x,enu_y,enu_z,enu_qx,enu_qy,enu_qz,enu_qw\n";
  for (const auto& [id, node] : store.nodes()) {
    out << id.agent.str() << ',' << id.seq << ',' << node.session << ',' << to_ns(node.stamp) << ',';
    write_pose(out, node.T_odom_base) << ',';
    write_fix(out, node.G, site) << ',' << node.submap_bytes << ',';
    // A node that is not placed has empty columns.
    if (const auto placed = placement.T_enu_node.find(id); placed != placement.T_enu_node.end()) {
      write_pose(out, placed->second) << '\n';
    } else {
      out << ",,,,,,\n";
    }
  }
  out.flush();
  if (!out) return failure(file.string() + ": cannot be written; is the disk full?");
  return {};
}

}  // namespace

Status keep_recipe(store::Store& store, const AgentConfig& config) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  const GeoPoint origin = config.site_origin.value_or(GeoPoint{kUnknown, kUnknown, kUnknown});
  const graph::PlacementConfig& placement = config.placement;
  const StoredRecipe values{origin.latitude,
                            origin.longitude,
                            origin.altitude,
                            config.map.voxel_m,
                            config.map.centroids ? 1.0 : 0.0,
                            placement.method == graph::PlacementMethod::graph ? 1.0 : 0.0,
                            placement.paper.max_rmse,
                            placement.paper.gps_correlation_time,
                            placement.fleet.gps_correlation_time,
                            placement.fleet.gps_drift_share,
                            placement.fleet.window_m,
                            placement.fleet.alignment_floor_m,
                            placement.fleet.alignment_floor_rad};
  Bytes bytes(sizeof(values));
  std::memcpy(bytes.data(), values.data(), sizeof(values));
  return store.set_meta(kRecipeKey, bytes);
}

std::optional<MapRecipe> map_recipe(const store::Store& store) {
  const auto stored = store.meta(kRecipeKey);
  StoredRecipe values{};
  if (!stored || !*stored || (*stored)->size() != sizeof(values)) return std::nullopt;
  std::memcpy(values.data(), (*stored)->data(), sizeof(values));
  MapRecipe recipe;
  const GeoPoint configured{values[0], values[1], values[2]};
  const auto origin = site_origin(store, std::isnan(values[0]) ? std::nullopt : std::optional(configured));
  if (!origin) return std::nullopt;
  recipe.origin = *origin;
  recipe.merge = {.voxel_m = values[3], .centroids = values[4] != 0.0};
  recipe.placement.method = values[5] != 0.0 ? graph::PlacementMethod::graph : graph::PlacementMethod::paper;
  recipe.placement.paper = {.max_rmse = values[6], .gps_correlation_time = values[7]};
  recipe.placement.fleet = {.gps_correlation_time = values[8],
                            .gps_drift_share = values[9],
                            .window_m = values[10],
                            .alignment_floor_m = values[11],
                            .alignment_floor_rad = values[12]};
  if (!is_valid(recipe.origin) || !recipe.merge.validate() || !recipe.placement.validate())
    return std::nullopt;
  return recipe;
}

std::optional<GeoPoint> site_origin(const store::Store& store, const std::optional<GeoPoint>& configured) {
  if (configured) return configured;
  if (store.nodes().empty()) return std::nullopt;
  for (const auto& [id, node] : store.nodes()) {
    if (node.G) return node.G->position;
  }
  return GeoPoint{};
}

std::vector<graph::Node> nodes_of(const store::Store& store) {
  std::vector<graph::Node> nodes;
  for (const auto& [id, node] : store.nodes()) nodes.push_back(node);
  return nodes;
}

std::vector<graph::Alignment> alignments_of(const store::Store& store) {
  std::vector<graph::Alignment> alignments;
  for (const auto& [id, alignment] : store.alignments()) alignments.push_back(alignment);
  return alignments;
}

graph::Placement place(const store::Store& store, const GeoPoint& origin,
                       const graph::PlacementConfig& config, std::span<const NodeId> covariance_of) {
  return graph::compute_placement(nodes_of(store), alignments_of(store), LocalFrame(origin), config,
                                  covariance_of);
}

store::MergedMap main_map(store::Store& store, const graph::Placement& placement,
                          const store::MergeConfig& config) {
  return merged_map(store, map_parts(nodes_of(store), placement).main.T_map_node, config);
}

Result<Results> write_results(store::Store& store, const AgentConfig& config,
                              std::span<const MapFiles> others) {
  const std::optional<GeoPoint> origin = site_origin(store, config.site_origin);
  if (!origin) {
    return failure(config.id.str() +
                   ": there is no map to write: no node was made or received; did GPS and LiDAR arrive?");
  }
  Results results;
  results.origin = *origin;
  if (const Status kept = keep_recipe(store, config); !kept) return tl::unexpected(kept.error());
  results.placement = place(store, *origin, config.placement);
  results.not_georeferenced = graph::not_georeferenced(nodes_of(store), results.placement.components);
  MapParts parts = map_parts(nodes_of(store), results.placement);
  results.apart = std::move(parts.apart);
  auto map = write_map(store, parts.main.T_map_node, config, others);
  if (!map) return tl::unexpected(map.error());
  results.map = std::move(*map);
  results.missing_submaps = store.nodes().size() - results.map.submaps;
  remove_parts(config.directory);
  for (const MapPart& part : results.apart) {
    const Result<std::size_t> submaps = write_part(store, part, config);
    if (!submaps) return tl::unexpected(submaps.error());
    results.missing_submaps -= *submaps;
  }
  const LocalFrame site(*origin);
  for (const Status& written :
       {write_trajectory(store, results.placement, config), write_global_poses(site, config),
        write_alignments(store, results.placement, config),
        write_nodes(store, results.placement, site, config.directory / "nodes.csv")}) {
    if (!written) return tl::unexpected(written.error());
  }
  return results;
}

}  // namespace fleetmap::agent
