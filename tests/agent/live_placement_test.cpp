#include "live_placement.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "fleetmap/bus/local_network.hpp"
#include "fleetmap/fleet_codec/messages.hpp"
#include "fleetmap/fleet_codec/topics.hpp"
#include "store/items.hpp"
#include "support/robots.hpp"

namespace fleetmap::agent {
namespace {

using fleetmap::testing::kPeer;
using fleetmap::testing::kSelf;

/// Two robots on one straight way to the east, 5 m between nodes, the other's 3 m beside ours. Our odometry
/// began somewhere else, turned; nobody told where.
class LivePlacementTest : public ::testing::Test {
 protected:
  void SetUp() override {
    auto network = bus::LocalNetwork::create({});
    ASSERT_TRUE(network);
    network_ = std::move(*network);
    bus_ = &network_->add_robot(kSelf);
    subscription_ = bus_->subscribe(fleet_codec::topics::corrected_pose(), [this](const Bytes& cdr) {
      heard_.push_back(fleet_codec::decode<GlobalPose>(cdr).value());
    });
    config_.id = kSelf;
    config_.site_origin = origin_;
    config_.placement.method = graph::PlacementMethod::graph;
    live_ = std::make_unique<LivePlacement>(
        config_, *bus_, store_,
        [this](std::span<const graph::Alignment> used) { used_.push_back(used.size()); });
  }

  static Pose T_enu_node(const AgentId& agent, std::uint32_t seq) {
    return make_pose(Eigen::Matrix3d::Identity(),
                     Eigen::Vector3d(5.0 * seq, agent == kSelf ? 0.0 : 3.0, 0.0));
  }
  Pose T_odom_base(std::uint32_t seq) const { return T_enu_odom_.inverse() * T_enu_node(kSelf, seq); }

  void add_node(const AgentId& agent, std::uint32_t seq, bool located) {
    graph::Node node;
    node.id = {agent, seq};
    node.stamp = stamp_from_ns(1'000'000'000LL * (seq + 1));
    node.T_odom_base = agent == kSelf ? T_odom_base(seq) : T_enu_node(agent, seq);
    node.odom_covariance = 1e-4 * Matrix6d::Identity();
    if (located) {
      node.G.emplace();
      node.G->stamp = node.stamp;
      node.G->position = LocalFrame(origin_).to_geo(T_enu_node(agent, seq).translation());
      node.G->covariance = Vector6d(0.01, 0.01, 0.01, 1e-4, 1e-4, 1e-4).asDiagonal();
    }
    const Result<store::Put> put = store_.put_node(node);
    ASSERT_TRUE(put && *put == store::Put::kAdded);
  }
  void add_alignment(std::uint32_t seq) {
    graph::Alignment alignment = testing::make_alignment({kSelf, seq}, {kPeer, seq}, kPeer, seq);
    alignment.modes.front().T_i_j = T_enu_node(kSelf, seq).inverse() * T_enu_node(kPeer, seq);
    const Result<store::Put> put = store_.put_alignment(alignment);
    ASSERT_TRUE(put && *put == store::Put::kAdded);
  }
  void solve() {
    EXPECT_FALSE(live_->idle()) << "something is new";
    live_->refresh(0);
    network_->run_until(network_->now() + std::chrono::seconds(2));
    EXPECT_TRUE(live_->idle());
  }
  /// Poses published while the odometry is at our node `seq`.
  std::vector<GlobalPose> heard_at(std::uint32_t seq) {
    heard_.clear();
    live_->publish({kSelf, 0}, {stamp_from_ns(1'000'000'000LL * (seq + 1)), T_odom_base(seq)});
    network_->run_until(network_->now() + std::chrono::seconds(1));
    return heard_;
  }

  GeoPoint origin_ = geo_point_from_degrees(39.0, -3.0, 600.0);
  Pose T_enu_odom_ = make_pose(rotation_from_rpy(0.0, 0.0, 2.0), Eigen::Vector3d(-80.0, 30.0, 1.0));
  testing::TemporaryFolder folder_;
  store::Store store_ = std::move(
      store::Store::open(folder_ / "store.db", kSelf, {.power_safe = false, .file_system = {}}).value());
  AgentConfig config_;
  std::unique_ptr<bus::LocalNetwork> network_;
  bus::Bus* bus_ = nullptr;
  bus::Handle subscription_;
  std::vector<GlobalPose> heard_;
  std::vector<std::size_t> used_;
  std::unique_ptr<LivePlacement> live_;
};

TEST_F(LivePlacementTest, ARobotThatNobodyCanPlaceHasNoCorrectedPoseUntilTheFleetPlacesIt) {
  for (std::uint32_t seq = 0; seq < 12; ++seq) add_node(kSelf, seq, false);
  for (std::uint32_t seq = 0; seq < 12; ++seq) add_node(kPeer, seq, true);
  solve();
  EXPECT_EQ(used_, std::vector<std::size_t>{0});
  EXPECT_TRUE(heard_at(11).empty());
  const auto nowhere = live_->placed({kSelf, 0});
  ASSERT_TRUE(nowhere) << "it has a map all the same";
  EXPECT_FALSE(nowhere->georeferenced);

  for (const std::uint32_t seq : {2u, 6u, 10u}) add_alignment(seq);
  solve();
  EXPECT_EQ(used_.back(), 3u);
  const auto heard = heard_at(11);
  ASSERT_EQ(heard.size(), 1u);
  const Pose T = pose_in(LocalFrame(origin_), heard.front());
  EXPECT_LT((T_enu_node(kSelf, 11).inverse() * T).translation().norm(), 0.3);
  EXPECT_LT(so3_log(T.linear()).norm(), 0.05);
  const auto placed = live_->placed({kSelf, 0});
  ASSERT_TRUE(placed);
  EXPECT_TRUE(placed->georeferenced);
  EXPECT_LT(((placed->T_enu_odom * T_odom_base(11)).translation() - T.translation()).norm(), 1e-6);
  EXPECT_FALSE(live_->placed({kSelf, 1})) << "of another start";
  EXPECT_EQ(live_->fleet()->nodes.size(), 24u);
  EXPECT_EQ(live_->fleet()->placement.T_enu_node.size(), 24u);
  EXPECT_GT(heard.front().covariance(0, 0), 0.0);
  EXPECT_LT(heard.front().covariance(0, 0), 1.0);
}

TEST_F(LivePlacementTest, FollowsTheOdometryBetweenSolutionsAndIgnoresThatOfAnotherStart) {
  for (std::uint32_t seq = 0; seq < 8; ++seq) add_node(kSelf, seq, true);
  solve();
  const LocalFrame site(origin_);
  const auto at_7 = heard_at(7);
  const auto at_9 = heard_at(9);  // of which there is no node
  ASSERT_TRUE(at_7.size() == 1 && at_9.size() == 1);
  const Eigen::Vector3d moved =
      pose_in(site, at_9.front()).translation() - pose_in(site, at_7.front()).translation();
  EXPECT_LT((moved - Eigen::Vector3d(10.0, 0.0, 0.0)).norm(), 0.05);
  heard_.clear();
  live_->publish({kSelf, 1}, {stamp_from_ns(0), Pose::Identity()});
  network_->run_until(network_->now() + std::chrono::seconds(1));
  EXPECT_TRUE(heard_.empty());
  // Nothing new, nothing solved.
  live_->refresh(0);
  EXPECT_EQ(used_.size(), 1u);
}

/// Twice the nodes cost twice as much, so that they are placed half as often.
TEST_F(LivePlacementTest, SolutionsTakeTheSameShareOfTheCpuWithAnyNumberOfNodes) {
  const LivePlacementConfig& live = config_.live_placement;
  constexpr Duration kTime = std::chrono::minutes(5);
  std::uint32_t seq = 0;
  for (const std::uint32_t nodes : {3'000u, 6'000u}) {
    for (; seq < nodes; ++seq) add_node(kSelf, seq, seq == 0);
    live_->refresh(0);
    network_->run_until(network_->now() + std::chrono::minutes(1));  // the pause after it
    const std::size_t before = used_.size();
    for (const Stamp begun = network_->now(); network_->now() < begun + kTime;
         network_->run_until(network_->now() + live.period)) {
      add_node(kSelf, seq++, false);
      live_->refresh(0);
    }
    const auto solutions = static_cast<double>(used_.size() - before);
    const double share = solutions * nodes * to_seconds(live.cost_per_node) / to_seconds(kTime);
    EXPECT_LT(share, 1.1 * live.cpu_share) << nodes;
    EXPECT_GT(share, 0.5 * live.cpu_share) << nodes;
  }
}

TEST_F(LivePlacementTest, ASessionThatBeginsWaitsForNoPause) {
  config_.live_placement.cost_per_node = std::chrono::seconds(10);
  for (std::uint32_t seq = 0; seq < 8; ++seq) add_node(kSelf, seq, true);
  solve();
  add_node(kSelf, 8, true);
  live_->refresh(0);
  network_->run_until(network_->now() + std::chrono::seconds(5));
  EXPECT_EQ(used_.size(), 1u) << "one more in the same session";
  add_node(kSelf, first_seq(1), true);
  live_->refresh(1);
  network_->run_until(network_->now() + std::chrono::seconds(5));
  EXPECT_EQ(used_.size(), 2u);
}

}  // namespace
}  // namespace fleetmap::agent
