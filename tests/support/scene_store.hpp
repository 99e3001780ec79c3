#pragma once

#include <gtest/gtest.h>

#include <map>

#include "cloud/scenes.hpp"
#include "fleetmap/cloud/codec.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::testing {

inline const GeoPoint kSceneOrigin = geo_point_from_degrees(49.0, 8.4, 110.0);
inline constexpr double kSceneSpacing = 40.0;  ///< m, of the nodes of a robot, from west to east
/// 2026-11-25 18:12:39 UTC, of the first node of each robot; the others follow after a second each.
inline constexpr std::int64_t kSceneStart_ns = 1'795'630'359'000'000'000;

/// Two robots that drove eastwards through streets, three nodes each with a submap of 2000 points that have
/// intensities up to 255. `located`: with GPS.
inline std::map<NodeId, Pose> add_scene(store::Store& store, bool located = true) {
  const LocalFrame enu(kSceneOrigin);
  std::map<NodeId, Pose> T_enu_node;
  for (const char* name : {"r1", "r2"}) {
    for (std::uint32_t seq = 0; seq < 3; ++seq) {
      const unsigned seed = seq + static_cast<unsigned>(name[1]);
      cloud::PointCloud cloud = cloud::testing::street_scene(2000, seed);
      for (std::size_t k = 0; k < cloud.size(); ++k) cloud.intensities[k] = static_cast<float>(k % 256);
      const Bytes submap = cloud::encode(cloud, {.resolution_m = 0.01}).value();
      const Eigen::Vector3d p_odom(kSceneSpacing * seq, 0.0, 0.0);
      const Eigen::Vector3d p_enu = p_odom + Eigen::Vector3d(0.0, name[1] == '2' ? 15.0 : 0.0, 0.0);
      graph::Node node;
      node.id = {AgentId::parse(name).value(), seq};
      node.stamp = stamp_from_ns(kSceneStart_ns + std::int64_t{seq} * 1'000'000'000);
      node.T_odom_base = make_pose(Eigen::Matrix3d::Identity(), p_odom);
      node.odom_covariance = 1e-6 * Matrix6d::Identity();
      if (located) {
        node.G.emplace();
        node.G->stamp = node.stamp;
        node.G->position = enu.to_geo(p_enu);
        node.G->covariance = 1e-2 * Matrix6d::Identity();
      }
      node.submap_hash = content_hash(submap);
      node.submap_bytes = static_cast<std::uint32_t>(submap.size());
      EXPECT_EQ(store.put_node_with_submap(node, submap).value(), store::Put::kAdded);
      T_enu_node[node.id] = make_pose(Eigen::Matrix3d::Identity(), p_enu);
    }
  }
  return T_enu_node;
}

}  // namespace fleetmap::testing
