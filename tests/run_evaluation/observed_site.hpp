#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "fleetmap/cloud/codec.hpp"
#include "fleetmap/output/placed_store.hpp"
#include "fleetmap/store/sessions.hpp"
#include "stored_fleet.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::run_evaluation {

/// Ground of 6 m x 6 m at z = 0.5 m, and along its middle a wall of 2 m, sampled every 0.1 m.
inline cloud::PointCloud small_site() {
  cloud::PointCloud site;
  for (int a = 0; a < 60; ++a) {
    const float x = 0.05f + 0.1f * static_cast<float>(a);
    for (int b = 0; b < 60; ++b) site.points.emplace_back(x, 0.05f + 0.1f * static_cast<float>(b), 0.5f);
    for (int c = 0; c < 20; ++c) site.points.emplace_back(x, 3.05f, 0.55f + 0.1f * static_cast<float>(c));
  }
  return site;
}

/// A store with a node of r1, which saw the western 4 m of small_site(), and one of r2, which saw the
/// eastern 4 m. Both lie where they truly are.
class ObservedSite : public ::testing::Test {
 protected:
  ObservedSite() {
    held_.recipe.origin = geo_point_from_degrees(48.0, 11.0, 500.0);
    const auto session = [] { return std::uint16_t{0}; };
    EXPECT_TRUE(store::Sessions::load(held_.store)->begin(held_.store, session));
    put(a_, 0.0f, 4.0f, {1.0, 3.0, 0.5});
    put(b_, 2.0f, 6.0f, {5.0, 3.0, 0.5});
    held_.placement.components = {{{a_.agent, 0}}, {{b_.agent, 0}}};
  }
  void put(const NodeId& id, float from, float to, const Eigen::Vector3d& place) {
    const Pose T = make_pose(Eigen::Matrix3d::Identity(), place);
    cloud::PointCloud visible;
    for (const auto& p : site_.points) {
      if (p.x() >= from && p.x() < to) visible.points.push_back(p);
    }
    const Bytes submap =
        cloud::encode(cloud::transformed(visible, T.inverse()), {.resolution_m = 0.005}).value();
    graph::Node node;
    node.id = id;
    node.stamp = stamp_from_ns(1'000'000'000);
    node.G.emplace();
    node.G->stamp = node.stamp;
    node.G->position = LocalFrame(held_.recipe.origin).to_geo(place);
    node.G->covariance = 1e-4 * Matrix6d::Identity();
    node.submap_hash = content_hash(submap);
    node.submap_bytes = static_cast<std::uint32_t>(submap.size());
    ASSERT_EQ(held_.store.put_node_with_submap(node, submap).value(), store::Put::kAdded);
    held_.placement.T_enu_node[id] = T;
    held_.placement.T_enu_odom[{id.agent, 0}] = T;
    truth_[id] = T;
  }

  testing::TemporaryFolder folder_;
  const NodeId a_{AgentId::parse("r1").value(), 0}, b_{AgentId::parse("r2").value(), 0};
  const cloud::PointCloud site_ = small_site();
  StoredFleet held_{std::move(store::Store::open(folder_.path() / "store.db", a_.agent).value()), {}, {}, {}};
  std::map<NodeId, Pose> truth_;
};

}  // namespace fleetmap::run_evaluation
