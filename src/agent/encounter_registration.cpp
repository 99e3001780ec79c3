#include "fleetmap/agent/encounter_registration.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

#include "fleetmap/cloud/codec.hpp"
#include "fleetmap/cloud/voxel_grid.hpp"

namespace fleetmap::agent {
namespace {

/// Modes of an ambiguous registration that score at least this share of the best are alternatives to it.
constexpr double kAlternativeShare = 0.7;

}  // namespace

std::vector<std::pair<NodeId, Pose>> submaps_around(const store::Store& store, const graph::Node& node,
                                                    double radius) {
  std::vector<std::pair<NodeId, Pose>> around;
  for (const graph::Node* other : store.nodes_from({node.id.agent, 0, store.next_node_seq()})) {
    if (other->frame() != node.frame() || !store.has_submap(other->id)) continue;
    const Pose T_node_submap = node.T_odom_base.inverse() * other->T_odom_base;
    if (T_node_submap.translation().norm() <= radius) around.emplace_back(other->id, T_node_submap);
  }
  return around;
}

Surroundings gather(store::Store& store, const graph::Node& node, double radius) {
  Surroundings surroundings{node, {}};
  for (const auto& [id, T_node_submap] : submaps_around(store, node, radius)) {
    Result<Bytes> encoded = store.submap(id);
    if (encoded) {
      surroundings.submaps.emplace_back(T_node_submap, std::move(*encoded));
    } else {
      spdlog::warn("{}", encoded.error().message);
    }
  }
  return surroundings;
}

Result<registration::SpherizedCloud> spherize(const Surroundings& surroundings,
                                              const registration::SpherizeConfig& config) {
  cloud::VoxelMerger merger(config.voxel_m, cloud::VoxelPoint::centroid);
  for (const auto& [T_node_submap, encoded] : surroundings.submaps) {
    const Result<cloud::PointCloud> submap = cloud::decode(encoded);
    if (!submap) return tl::unexpected(submap.error());
    merger.add(cloud::transformed(*submap, T_node_submap));
  }
  const Eigen::Vector3d up = surroundings.node.G.q_enu_base.conjugate() * Eigen::Vector3d::UnitZ();
  return registration::spherize(merger.cloud(), up.cast<float>(), config);
}

registration::Prior prior_of(const graph::Node& target, const graph::Node& source) {
  const LocalFrame frame(target.G.position);
  registration::Prior prior;
  prior.T_target_source = pose_in(frame, target.G).inverse() * pose_in(frame, source.G);
  const Matrix6d covariance = target.G.covariance + source.G.covariance;
  const Eigen::Vector3d rotation = covariance.diagonal().tail<3>();
  // Yaw moves the other node on a circle around ours: its error is one of position too.
  const double swing = std::sqrt(rotation.z()) * prior.T_target_source.translation().norm();
  prior.sigma_translation_m = std::sqrt(covariance.diagonal().head<3>().maxCoeff() + swing * swing);
  prior.sigma_yaw_rad = std::sqrt(rotation.z());
  prior.sigma_tilt_rad = std::sqrt(std::max(rotation.x(), rotation.y()));
  return prior;
}

graph::Alignment alignment_of(const NodeId& i, const NodeId& j, const AgentId& computed_by,
                              const registration::RegistrationResult& result) {
  graph::Alignment alignment{i, j, computed_by, 0, {}};
  if (result.verdict != registration::Verdict::ambiguous) {
    const double score = result.modes.empty() ? result.agreement : result.modes.front().score;
    alignment.modes = {
        {result.T_target_source, result.rmse, result.inlier_fraction, score, result.covariance}};
    return alignment;
  }
  for (const registration::Mode& mode : result.modes) {
    if (alignment.modes.size() == graph::Alignment::kMaxModes) break;
    if (mode.score < kAlternativeShare * result.modes.front().score) break;
    alignment.modes.push_back(
        {mode.T_target_source, mode.rmse, mode.inlier_fraction, mode.score, result.covariance});
  }
  return alignment;
}

}  // namespace fleetmap::agent
