#include "fleetmap/loop_closure/map_sessions.hpp"

#include <gtest/gtest.h>

#include "fleetmap/cloud/codec.hpp"
#include "loop_closure/own_sessions.hpp"
#include "loop_closure/two_robots.hpp"
#include "registration/made_world.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::loop_closure {
namespace {

using registration::testing::error_between;

/// A robot drives through a made-up place twice; GPS of the second day is off.
class MapSessionAlignmentTest : public ::testing::Test {
 protected:
  MapSessionAlignmentTest() {
    config_.spherize.radius_m = 30.0f;
    for (std::uint32_t k = 0; k < 4; ++k) {
      add(0, k, pose(-15.0 + 8.0 * k, 0.0, 0.1), {0.0, 0.0, 0.0});
      add(1, k, pose(14.0 - 8.0 * k, 3.0, 3.0), {1.4, -0.9, 1.0});
    }
  }
  void add(std::uint16_t session, std::uint32_t k, const Pose& T_world_base, const Eigen::Vector3d& error) {
    graph::Node node;
    node.id = {kA, first_seq(session) + k};
    node.session = session;
    node.T_odom_base = pose(100.0, -40.0, 1.0 + session) * T_world_base;
    node.odom_covariance = Vector6d(1e-4, 1e-4, 1e-4, 1e-6, 1e-6, 1e-6).asDiagonal();
    GlobalPose G;
    G.position = LocalFrame(kOrigin).to_geo(T_world_base.translation() + error);
    G.q_enu_base = Eigen::Quaterniond(T_world_base.linear());
    G.covariance.diagonal() << 2.0, 2.0, 2.0, 1e-4, 1e-4, 1e-2;
    node.G = G;
    const Bytes submap =
        cloud::encode(world_.scan(T_world_base, 15'000, 0.02, 10 * session + k + 1), {}).value();
    node.submap_hash = content_hash(submap);
    node.submap_bytes = static_cast<std::uint32_t>(submap.size());
    ASSERT_EQ(store_.put_node_with_submap(node, submap).value(), store::Put::kAdded);
    T_world_base_[node.id] = T_world_base;
    days_[session].insert(node.frame());
  }

  registration::testing::MadeWorld world_{7};
  testing::TemporaryFolder folder_;
  store::Store store_ = std::move(store::Store::open(folder_.path() / "store.db", kA).value());
  std::map<NodeId, Pose> T_world_base_;
  MapSession days_[2];
  MapSessionConfig config_;
};

TEST_F(MapSessionAlignmentTest, AlignsTheTwoDaysThoughGpsOfOneIsOff) {
  const MapSessionAlignments aligned = align_map_sessions(store_, days_[0], days_[1], config_);
  EXPECT_GE(aligned.accepted, 2u);
  ASSERT_EQ(aligned.found.size(), aligned.accepted + aligned.ambiguous);
  for (const graph::Alignment& alignment : aligned.found) {
    EXPECT_EQ(session_of(alignment.i.seq), 0);
    EXPECT_EQ(session_of(alignment.j.seq), 1);
    EXPECT_EQ(alignment.computed_by, kA);
    const Pose truth = T_world_base_.at(alignment.i).inverse() * T_world_base_.at(alignment.j);
    EXPECT_LT(error_between(truth, alignment.best().T_i_j).translation_m, 0.05);
    EXPECT_TRUE(store_.put_alignment(alignment));
  }
}

TEST_F(MapSessionAlignmentTest, FramesThatBothDaysHaveAreNotPaired) {
  const MapSession both = map_session_of(store_);
  EXPECT_EQ(both.size(), 2u);
  EXPECT_EQ(align_map_sessions(store_, both, days_[1], config_).candidates, 0u);
  EXPECT_EQ(align_map_sessions(store_, both, both, config_).candidates, 0u);
}

}  // namespace
}  // namespace fleetmap::loop_closure
