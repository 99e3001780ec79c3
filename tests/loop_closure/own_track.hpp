#pragma once

#include <gtest/gtest.h>

#include "fleetmap/cloud/codec.hpp"
#include "fleetmap/store/store.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::testing {

/// A store with nodes of the robot r1 along the x axis of its odometry frame, each with a few points.
class OwnTrack {
 public:
  store::Store& store() { return store_; }

  graph::Node add(double x, std::uint16_t session = 0) {
    graph::Node node;
    node.id = {store_.self(), store_.next_node_seq(session)};
    node.session = session;
    node.T_odom_base.translation().x() = x;
    cloud::PointCloud points;
    for (int k = 0; k < 50; ++k) points.points.push_back({2.0f, 0.2f * static_cast<float>(k), 0.0f});
    const Bytes encoded = cloud::encode(points, {}).value();
    node.submap_hash = content_hash(encoded);
    node.submap_bytes = static_cast<std::uint32_t>(encoded.size());
    EXPECT_EQ(store_.put_node_with_submap(node, encoded).value(), store::Put::kAdded);
    return node;
  }

 private:
  TemporaryFolder folder_;
  store::Store store_ =
      std::move(store::Store::open(folder_.path() / "store.db", AgentId::parse("r1").value()).value());
};

}  // namespace fleetmap::testing
