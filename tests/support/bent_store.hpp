#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "fleetmap/cloud/codec.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::testing {

/// A fleet whose member r3 lies: r1, r2 and r3 drive side by side, 10 m apart, with GPS of 3 m, and r3's
/// alignments, which agree with one another and with GPS, have r2 kBend m beside where it is.
inline constexpr double kBend = 3.0;
inline const GeoPoint kBentSite = geo_point_from_degrees(48.0, 11.0, 500.0);
inline constexpr std::uint32_t kNodesEach = 12;

inline AgentId bent_robot(int number) { return AgentId::parse("r" + std::to_string(number)).value(); }

/// ENU, m.
inline Eigen::Vector3d bent_truth(int robot, std::uint32_t seq) { return {5.0 * seq, 10.0 * robot, 0.0}; }

inline Matrix6d bent_covariance(double sigma_m, double sigma_rad) {
  Vector6d sigmas;
  sigmas << sigma_m, sigma_m, sigma_m, sigma_rad, sigma_rad, sigma_rad;
  return sigmas.cwiseAbs2().asDiagonal();
}

/// Each submap is one point at its node.
inline void add_bent_fleet(store::Store& store) {
  const LocalFrame site(kBentSite);
  const Bytes submap = cloud::encode({{{0.0f, 0.0f, 0.0f}}, {}}, {.resolution_m = 0.02}).value();
  for (int robot = 1; robot <= 3; ++robot) {
    for (std::uint32_t seq = 0; seq < kNodesEach; ++seq) {
      graph::Node node;
      node.id = {bent_robot(robot), seq};
      node.stamp = stamp_from_ns(1'000'000'000LL * (seq + 1));
      node.T_odom_base.translation().x() = 5.0 * seq;
      if (seq > 0) node.odom_covariance = bent_covariance(0.01, 0.001);
      node.G.emplace();
      node.G->stamp = node.stamp;
      node.G->position = site.to_geo(bent_truth(robot, seq));
      node.G->covariance = bent_covariance(3.0, 0.05);
      node.submap_hash = content_hash(submap);
      node.submap_bytes = static_cast<std::uint32_t>(submap.size());
      store.put_node_with_submap(node, submap).value();
    }
  }
  for (std::uint32_t k = 0; k < 2 * kNodesEach; ++k) {
    const int other = 1 + static_cast<int>(k % 2);
    graph::Alignment alignment;
    alignment.i = {bent_robot(3), k / 2};
    alignment.j = {bent_robot(other), k / 2};
    alignment.computed_by = bent_robot(3);
    alignment.seq = k;
    graph::AlignmentMode& mode = alignment.modes.front();
    mode.T_i_j.translation() = bent_truth(other, k / 2) - bent_truth(3, k / 2);
    if (other == 2) mode.T_i_j.translation().y() += kBend;
    mode.rmse = 0.1;
    mode.inlier_fraction = 0.8;
    mode.score = 0.7;
    mode.covariance = bent_covariance(0.02, 0.002);
    store.put_alignment(alignment).value();
  }
}

}  // namespace fleetmap::testing
