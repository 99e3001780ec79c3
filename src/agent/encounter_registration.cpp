#include "fleetmap/agent/encounter_registration.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

#include "fleetmap/cloud/codec.hpp"
#include "fleetmap/cloud/voxel_grid.hpp"

namespace fleetmap::agent {

Surroundings gather(store::Store& store, const graph::Node& node, double radius) {
  Surroundings surroundings{node, {}};
  const SeqRange all{node.id.agent, 0, store.next_node_seq()};
  for (const graph::Node* other : store.nodes_from(all)) {
    if (other->frame() != node.frame() || !store.has_submap(other->id)) continue;
    const Pose T_node_submap = node.T_odom_base.inverse() * other->T_odom_base;
    if (T_node_submap.translation().norm() > radius) continue;
    Result<Bytes> encoded = store.submap(other->id);
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
  graph::Alignment alignment;
  alignment.i = i;
  alignment.j = j;
  alignment.computed_by = computed_by;
  alignment.T_i_j = result.T_target_source;
  alignment.rmse = result.rmse;
  alignment.inlier_fraction = result.inlier_fraction;
  alignment.covariance = result.covariance;
  return alignment;
}

}  // namespace fleetmap::agent
