#include "frame_transforms.hpp"

#include <gtest/gtest.h>

#include <random>

#include "loop_closure/two_robots.hpp"

namespace fleetmap::loop_closure {
namespace {

/// Two robots that drive side by side, 8 m apart, a node every 4 m; b's odometry frame lies anywhere.
class FrameTransformsTest : public ::testing::Test {
 protected:
  static constexpr std::uint32_t kNodes = 60;

  static Pose T_enu_node(const AgentId& agent, std::uint32_t seq) {
    return make_pose(rotation_from_rpy(0.01, -0.02, agent == kA ? 0.1 : 0.1 + 0.02 * seq),
                     Eigen::Vector3d(4.0 * seq, agent == kA ? 0.0 : 8.0, 0.1 * seq));
  }
  static Pose T_enu_odom(const AgentId& agent) {
    if (agent == kA) return Pose::Identity();
    return make_pose(rotation_from_rpy(0.0, 0.0, 2.0), Eigen::Vector3d(100.0, -40.0, 3.0));
  }
  static graph::Node node(const AgentId& agent, std::uint32_t seq, std::uint16_t session = 0) {
    graph::Node node;
    node.id = {agent, seq};
    node.session = session;
    node.T_odom_base = T_enu_odom(agent).inverse() * T_enu_node(agent, seq);
    node.odom_covariance = 1e-4 * Matrix6d::Identity();
    return node;
  }
  static Pose T_i_j(const NodeId& i, const NodeId& j) {
    return T_enu_node(i.agent, i.seq).inverse() * T_enu_node(j.agent, j.seq);
  }
  static graph::Alignment alignment(const NodeId& i, const NodeId& j) {
    graph::Alignment alignment;
    alignment.i = i;
    alignment.j = j;
    alignment.modes.front().T_i_j = T_i_j(i, j);
    alignment.modes.front().covariance = 1e-4 * Matrix6d::Identity();
    return alignment;
  }
  void add_all() {
    for (std::uint32_t seq = 0; seq < kNodes; ++seq) {
      transforms_.add(node(kA, seq));
      transforms_.add(node(kB, seq));
    }
  }
  static std::vector<graph::Alignment> three() {
    return {alignment({kA, 3}, {kB, 4}), alignment({kB, 20}, {kA, 21}), alignment({kA, 40}, {kB, 38})};
  }

  FrameTransforms transforms_;
};

TEST_F(FrameTransformsTest, GiveTheRelativePoseOfAnyTwoNodes) {
  add_all();
  transforms_.use(three());
  const auto known = transforms_.known();
  ASSERT_EQ(known.size(), 2u);
  const Pose T_a_b = T_enu_odom(kA).inverse() * T_enu_odom(kB);
  EXPECT_LT(se3_log(T_a_b.inverse() * known.at({{kA, 0}, {kB, 0}})).norm(), 1e-9);
  EXPECT_LT(se3_log(T_a_b * known.at({{kB, 0}, {kA, 0}})).norm(), 1e-9);
  for (const auto& [i, j] :
       {std::pair{NodeId{kA, 55}, NodeId{kB, 50}}, {{kA, 0}, {kB, 59}}, {{kB, 19}, {kA, 20}}}) {
    const auto told = transforms_.between(i, j);
    ASSERT_TRUE(told);
    EXPECT_LT(se3_log(T_i_j(i, j).inverse() * told->T_a_b).norm(), 1e-9);
  }
}

TEST_F(FrameTransformsTest, NeedThreeAlignmentsThatAreInUse) {
  add_all();
  auto used = three();
  used.pop_back();
  // Alignments within one frame, or with an unknown node.
  used.push_back(alignment({kA, 1}, {kA, 30}));
  used.push_back(alignment({kA, 1}, {kB, kNodes}));
  transforms_.use(used);
  EXPECT_TRUE(transforms_.known().empty());
  EXPECT_FALSE(transforms_.between({kA, 3}, {kB, 4}));
  EXPECT_FALSE(transforms_.nearest({kA, 3}, kB));
  transforms_.use(three());
  EXPECT_TRUE(transforms_.between({kA, 3}, {kB, 4}));
  transforms_.use({});
  EXPECT_FALSE(transforms_.between({kA, 3}, {kB, 4}));
}

TEST_F(FrameTransformsTest, AreAsUncertainAsTheOdometryOnTheWay) {
  add_all();
  transforms_.use(three());
  const auto at_the_alignment = transforms_.between({kA, 40}, {kB, 38});
  const auto far = transforms_.between({kA, 59}, {kB, 59});
  ASSERT_TRUE(at_the_alignment && far);
  EXPECT_LT((at_the_alignment->covariance - 1e-4 * Matrix6d::Identity()).norm(), 1e-12);

  // By drawing every step's error: along a from 59 back to 40, the alignment, along b from 38 on to 59.
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0.0, 1e-2);
  const auto erring = [&](const Pose& T) {
    Vector6d xi;
    for (double& x : xi) x = normal(random);
    return Pose(T * se3_exp(xi));
  };
  constexpr int kDraws = 4000;
  Matrix6d sampled = Matrix6d::Zero();
  for (int draw = 0; draw < kDraws; ++draw) {
    Pose T_40_59 = Pose::Identity();
    for (std::uint32_t seq = 40; seq < 59; ++seq) T_40_59 = T_40_59 * erring(T_i_j({kA, seq}, {kA, seq + 1}));
    Pose T = T_40_59.inverse() * erring(T_i_j({kA, 40}, {kB, 38}));
    for (std::uint32_t seq = 38; seq < 59; ++seq) T = T * erring(T_i_j({kB, seq}, {kB, seq + 1}));
    const Vector6d error = se3_log(T_i_j({kA, 59}, {kB, 59}).inverse() * T);
    sampled += error * error.transpose() / kDraws;
  }
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(sampled(k, k) / far->covariance(k, k), 1.0, 0.15) << k;
}

TEST_F(FrameTransformsTest, FindTheNearestNodeOfTheOther) {
  add_all();
  transforms_.use(three());
  const auto of_a = transforms_.nearest({kA, 50}, kB);
  const auto of_b = transforms_.nearest({kB, 10}, kA);
  ASSERT_TRUE(of_a && of_b);
  EXPECT_EQ(of_a->id, (NodeId{kB, 50}));
  EXPECT_EQ(of_b->id, (NodeId{kA, 10}));
  EXPECT_NEAR(of_a->distance, 8.0, 0.1);
  EXPECT_FALSE(transforms_.nearest({kA, 50}, kA));
  EXPECT_FALSE(transforms_.nearest({kA, kNodes}, kB));
}

TEST_F(FrameTransformsTest, FollowNoOdometryOverAGap) {
  for (std::uint32_t seq = 0; seq < kNodes; ++seq) {
    transforms_.add(node(kA, seq));
    if (seq != 25 && seq != 45) transforms_.add(node(kB, seq));
  }
  transforms_.use(three());
  EXPECT_TRUE(transforms_.between({kA, 44}, {kB, 44}));
  EXPECT_FALSE(transforms_.between({kA, 46}, {kB, 46}));
  EXPECT_TRUE(transforms_.between({kA, 26}, {kB, 26})) << "from the other side";
  transforms_.add(node(kB, 45));
  EXPECT_TRUE(transforms_.between({kA, 46}, {kB, 46}));
}

TEST_F(FrameTransformsTest, FollowsNoOdometryIntoAnotherSession) {
  for (std::uint32_t seq = 0; seq < kNodes; ++seq) {
    transforms_.add(node(kA, seq, seq < 10 || seq >= 50 ? 0 : 1));  // numbers of sessions come round
    transforms_.add(node(kB, seq));
  }
  transforms_.use(
      std::vector{alignment({kA, 1}, {kB, 1}), alignment({kA, 2}, {kB, 2}), alignment({kA, 3}, {kB, 3})});
  EXPECT_TRUE(transforms_.between({kA, 9}, {kB, 9}));
  EXPECT_FALSE(transforms_.between({kA, 20}, {kB, 20}));
  EXPECT_FALSE(transforms_.between({kA, 55}, {kB, 55}));
}

}  // namespace
}  // namespace fleetmap::loop_closure
