#include "fleetmap/loop_closure/loop_closing.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "loop_closure/made_track.hpp"
#include "loop_closure/two_robots.hpp"

namespace fleetmap::loop_closure {
namespace {

using registration::Verdict;
using registration::testing::error_between;

LoopClosingConfig config() {
  LoopClosingConfig config;
  config.self = kA;
  config.spherize.radius_m = 20.0f;
  config.own_path.min_path = 45.0;
  config.own_path.min_nodes_after = 1;
  config.candidates.min_nodes_after = 0;
  return config;
}

/// Loop closing of robot `a`, and the results that it published.
class LoopClosingTest : public ::testing::Test {
 protected:
  LoopClosing::Outputs outputs() {
    return {[this](const Registration& done) { recorded_.push_back(done); },
            [this](const graph::Alignment& alignment) {
              if (accept_) published_.push_back(alignment);
              return accept_;
            },
            [this] { ++completed_; }};
  }
  static GlobalPose located_at(const Pose& T_world_base) {
    GlobalPose G;
    G.position = LocalFrame(geo_point_from_degrees(39.0, -3.0, 600.0)).to_geo(T_world_base.translation());
    G.q_enu_base = Eigen::Quaterniond(T_world_base.linear());
    G.covariance = Vector6d(1.0, 1.0, 1.0, 1e-4, 1e-4, 1e-3).asDiagonal();
    return G;
  }

  testing::MadeTrack track_{kA};
  bool accept_ = true;
  std::vector<Registration> recorded_;
  std::vector<graph::Alignment> published_;
  int completed_ = 0;
};

TEST_F(LoopClosingTest, AReturnToTheOwnPathBecomesAnAlignmentThatCorrectsTheOdometry) {
  LoopClosing closing(config(), track_.bus(), track_.store(), outputs());
  // 30 m along one lane and back along the next one, where the odometry has drifted by 0.6 m.
  std::vector<Pose> T_world_base;
  for (int k = 0; k <= 6; ++k) T_world_base.push_back(pose(5.0 * k - 15.0, 0.0, 0.0));
  for (int k = 6; k >= 0; --k) T_world_base.push_back(pose(5.0 * k - 15.0, 4.0, 3.14));
  for (std::uint32_t k = 0; k < T_world_base.size(); ++k) {
    const double drift = k < 7 ? 0.0 : 0.6;
    closing.on_own_node(track_.add(k, T_world_base[k], {drift, 0.0, 0.0}));
  }
  EXPECT_FALSE(closing.idle());
  track_.run();
  EXPECT_TRUE(closing.idle());
  ASSERT_FALSE(published_.empty());
  EXPECT_EQ(recorded_.size(), published_.size());
  EXPECT_EQ(completed_, static_cast<int>(published_.size()));
  for (const graph::Alignment& alignment : published_) {
    EXPECT_EQ(alignment.computed_by, kA);
    EXPECT_LT(alignment.i.seq, 7u);
    EXPECT_GE(alignment.j.seq, 7u);
    const Pose truth = T_world_base[alignment.i.seq].inverse() * T_world_base[alignment.j.seq];
    EXPECT_LT(error_between(truth, alignment.best().T_i_j).translation_m, 0.15);
  }
}

/// Robot `b` was at the same place; both robots have GPS.
class LoopClosingWithAPeer : public LoopClosingTest {
 protected:
  LoopClosingWithAPeer() {
    theirs_ = peer_.add(0, T_world_theirs_, Eigen::Vector3d::Zero(), located_at(T_world_theirs_));
    EXPECT_TRUE(track_.store().put_node(theirs_));
  }
  /// The cloud around the peer's node, as the peer makes it.
  Bytes their_cloud() {
    LoopClosingConfig of_peer = config();
    of_peer.self = kB;
    LoopClosing closing(of_peer, peer_.bus(), peer_.store(), {});
    std::optional<Bytes> cloud;
    closing.make_cloud(*peer_.store().node(theirs_.id),
                       [&](std::optional<Bytes> made) { cloud = std::move(made); });
    peer_.run();
    return cloud.value();
  }
  /// Both nodes become known, and the peer's cloud is requested and received.
  void receive(const Bytes& cloud) {
    exchange::CloudClient& scheduler = closing_.scheduler();
    scheduler.on_heard(kB, kStart);
    scheduler.on_node(ours_, kStart);
    scheduler.on_node(theirs_, kStart);
    const exchange::CloudDemand demand = scheduler.tick(kStart, true);
    ASSERT_EQ(demand.wanted.size(), 1u);
    EXPECT_EQ(demand.wanted[0].node, theirs_.id);
    scheduler.on_cloud(theirs_.id, cloud);
    closing_.register_received();
    track_.run();
  }

  Pose T_world_ours_ = pose(0.0, 0.0, 0.2), T_world_theirs_ = pose(5.0, 2.0, 1.0);
  testing::MadeTrack peer_{kB};
  graph::Node ours_ = track_.add(0, T_world_ours_, Eigen::Vector3d::Zero(), located_at(T_world_ours_));
  graph::Node theirs_;
  LoopClosing closing_{config(), track_.bus(), track_.store(), outputs()};
};

TEST_F(LoopClosingWithAPeer, AReceivedCloudBecomesAnAlignment) {
  receive(their_cloud());
  ASSERT_EQ(published_.size(), 1u);
  EXPECT_EQ(published_[0].i, ours_.id);
  EXPECT_EQ(published_[0].j, theirs_.id);
  EXPECT_LT(
      error_between(T_world_ours_.inverse() * T_world_theirs_, published_[0].best().T_i_j).translation_m,
      0.15);
  EXPECT_EQ(closing_.registrations().accepted, 1u);
  EXPECT_EQ(completed_, 1);
}

TEST_F(LoopClosingWithAPeer, ACloudThatCannotBeDecodedRejectsTheCandidate) {
  receive(Bytes(100, 1));
  EXPECT_TRUE(published_.empty());
  ASSERT_EQ(recorded_.size(), 1u);
  EXPECT_FALSE(recorded_[0].result);
  EXPECT_EQ(closing_.stats().rejected, 1u);
  EXPECT_EQ(completed_, 0);
}

TEST_F(LoopClosingWithAPeer, AnAlignmentThatIsRefusedRejectsTheCandidate) {
  accept_ = false;
  receive(their_cloud());
  EXPECT_EQ(recorded_.size(), 1u);
  EXPECT_EQ(closing_.stats().rejected, 1u);
  EXPECT_EQ(completed_, 0);
}

}  // namespace
}  // namespace fleetmap::loop_closure
