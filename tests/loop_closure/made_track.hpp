#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "fleetmap/bus/local_network.hpp"
#include "fleetmap/cloud/codec.hpp"
#include "fleetmap/store/store.hpp"
#include "registration/made_world.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::testing {

/// A robot in a made-up world: a store of nodes with scans as submaps, and a bus in virtual time.
class MadeTrack {
 public:
  explicit MadeTrack(const AgentId& self) : self_(self) {}

  /// A node of `agent` at T_world_base. Its odometry frame is the world's, with `error` before this node.
  graph::Node node(const AgentId& agent, std::uint32_t seq, const Pose& T_world_base,
                   const Eigen::Vector3d& error = Eigen::Vector3d::Zero()) const {
    graph::Node node;
    node.id = {agent, seq};
    node.stamp = stamp_from_ns(1'000'000'000'000 + std::int64_t{seq} * 4'000'000'000);
    node.T_odom_base = T_world_base;
    node.T_odom_base.translation() += error;
    node.odom_covariance = Vector6d(1e-2, 1e-2, 1e-4, 1e-6, 1e-6, 1e-6).asDiagonal();
    node.up_in_base = T_world_base.linear().transpose() * Eigen::Vector3d::UnitZ();
    return node;
  }
  /// The same, stored with a scan and, if the robot has GPS, with `G`.
  graph::Node add(std::uint32_t seq, const Pose& T_world_base,
                  const Eigen::Vector3d& error = Eigen::Vector3d::Zero(),
                  const std::optional<GlobalPose>& G = std::nullopt) {
    graph::Node made = node(self_, seq, T_world_base, error);
    made.G = G;
    const Bytes encoded = cloud::encode(world_.scan(T_world_base, 15'000, 0.02, seq + 1), {}).value();
    made.submap_hash = content_hash(encoded);
    made.submap_bytes = static_cast<std::uint32_t>(encoded.size());
    EXPECT_EQ(store_.put_node_with_submap(made, encoded).value(), store::Put::kAdded);
    return made;
  }
  store::Store& store() { return store_; }
  bus::Bus& bus() { return bus_; }
  /// Runs offloaded work and its results.
  void run() { network_->run_until(network_->now() + std::chrono::seconds(1)); }

 private:
  AgentId self_;
  registration::testing::MadeWorld world_{7};
  TemporaryFolder folder_;
  store::Store store_ = std::move(store::Store::open(folder_.path() / "store.db", self_).value());
  std::unique_ptr<bus::LocalNetwork> network_ = std::move(bus::LocalNetwork::create({}).value());
  bus::Bus& bus_ = network_->add_robot(self_);
};

}  // namespace fleetmap::testing
