#include "fleetmap/eval/alignment_errors.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "fleetmap/eval/observed_places.hpp"

namespace fleetmap::eval {
namespace {

NodeId node(const char* agent, std::uint32_t seq) { return {*AgentId::parse(agent), seq}; }

Pose at(double x, double y, double yaw = 0.0) {
  return make_pose(rotation_from_rpy(0.0, 0.0, yaw), {x, y, 0.0});
}

/// Two robots of three nodes each, side by side; truth in a frame of its own.
struct TwoRobots {
  TruePoses truth;
  graph::Placement placement;
  std::vector<graph::Alignment> alignments;

  TwoRobots() {
    const Pose T_truth_enu = se3_exp(Vector6d{5.0, -3.0, 1.0, 0.0, 0.0, 0.4});
    for (std::uint32_t k = 0; k < 3; ++k) {
      for (const auto& [name, y] : {std::pair{"r1", 0.0}, {"r2", 6.0}}) {
        placement.T_enu_node[node(name, k)] = at(4.0 * k, y);
        truth[node(name, k)] = T_truth_enu * at(4.0 * k, y);
      }
    }
    for (std::uint32_t k = 0; k < 3; ++k) add(node("r1", k), node("r2", k));
  }
  graph::Alignment& add(const NodeId& i, const NodeId& j) {
    graph::Alignment alignment;
    alignment.i = i;
    alignment.j = j;
    alignment.computed_by = i.agent;
    alignment.seq = static_cast<std::uint32_t>(alignments.size());
    alignment.modes.front().T_i_j = truth.at(i).inverse() * truth.at(j);
    alignments.push_back(alignment);
    return alignments.back();
  }
};

TEST(LaidOnTruth, IsTheShiftAndTheTurnBetweenBothFrames) {
  const TwoRobots fleet;
  const Pose T = laid_on_truth(fleet.placement.T_enu_node, fleet.truth);
  for (const auto& [id, T_enu_node] : fleet.placement.T_enu_node)
    EXPECT_TRUE((T * T_enu_node).translation().isApprox(fleet.truth.at(id).translation(), 1e-9));
  EXPECT_TRUE(laid_on_truth(fleet.placement.T_enu_node, {}).isApprox(Pose::Identity()));
  // One node alone tells no turn.
  const std::map<NodeId, Pose> one{*fleet.placement.T_enu_node.begin()};
  EXPECT_TRUE(laid_on_truth(one, fleet.truth).linear().isApprox(Eigen::Matrix3d::Identity()));
}

TEST(AlignmentErrors, RightOnesAreRightInWhateverFrameTheTruthIs) {
  const TwoRobots fleet;
  const auto errors = alignment_errors(fleet.alignments, fleet.placement, fleet.truth);
  ASSERT_EQ(errors.size(), 3u);
  for (const AlignmentError& one : errors) {
    EXPECT_TRUE(one.right);
    EXPECT_TRUE(one.between_robots);
    EXPECT_FALSE(one.used);
    EXPECT_LT(one.translation, 1e-9);
    EXPECT_LT(one.rotation, 1e-6);
  }
}

TEST(AlignmentErrors, OneRowOffIsWrongAndSoIsATurn) {
  TwoRobots fleet;
  Pose& slipped = fleet.alignments[0].modes.front().T_i_j;
  slipped = at(0.0, 7.0) * slipped;
  Pose& turned = fleet.alignments[1].modes.front().T_i_j;
  turned = turned * at(0.0, 0.0, 0.05);
  const auto errors = alignment_errors(fleet.alignments, fleet.placement, fleet.truth);
  EXPECT_FALSE(errors[0].right);
  EXPECT_NEAR(errors[0].offset.y(), 7.0, 1e-9);
  EXPECT_NEAR(errors[0].translation, 7.0, 1e-9);
  EXPECT_FALSE(errors[1].right);
  EXPECT_NEAR(errors[1].rotation, 0.05, 1e-9);
  EXPECT_TRUE(errors[2].right);
}

TEST(AlignmentErrors, SelectedModeCounts) {
  TwoRobots fleet;
  graph::Alignment& alignment = fleet.alignments[0];
  graph::AlignmentMode right = alignment.modes.front();
  alignment.modes.front().T_i_j = at(0.0, 7.0) * right.T_i_j;
  alignment.modes.push_back(right);
  auto errors = alignment_errors(fleet.alignments, fleet.placement, fleet.truth);
  EXPECT_TRUE(errors[0].ambiguous);
  EXPECT_FALSE(errors[0].right) << "its best mode is one row off";
  EXPECT_TRUE(errors[0].holds_right);
  fleet.placement.used = {alignment};
  fleet.placement.used.front().modes = {right};
  errors = alignment_errors(fleet.alignments, fleet.placement, fleet.truth);
  EXPECT_TRUE(errors[0].right) << "the placement took the other mode";
}

TEST(AlignmentErrors, UnknownNodesAreLeftOut) {
  TwoRobots fleet;
  fleet.truth.erase(node("r1", 1));
  EXPECT_EQ(alignment_errors(fleet.alignments, fleet.placement, fleet.truth).size(), 2u);
}

TEST(AlignmentErrors, RobotsThatAreJoinedARowOffAreAWrongMerge) {
  TwoRobots fleet;
  fleet.placement.used = {fleet.alignments[1]};
  auto pairs = joined_pairs(fleet.alignments, fleet.placement, fleet.truth);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_TRUE(pairs[0].right);
  EXPECT_EQ(pairs[0].pairs, 3u);
  for (std::uint32_t k = 0; k < 3; ++k) {
    Pose& T = fleet.placement.T_enu_node[node("r2", k)];
    T = at(0.0, 7.0) * T;
  }
  pairs = joined_pairs(fleet.alignments, fleet.placement, fleet.truth);
  EXPECT_FALSE(pairs[0].right);
  EXPECT_NEAR(pairs[0].translation, 7.0, 1e-9);
  fleet.placement.used.clear();
  EXPECT_TRUE(joined_pairs(fleet.alignments, fleet.placement, fleet.truth).empty());
}

TEST(OdometryErrors, AreThoseOfPiecesOfOneFrame) {
  constexpr std::uint32_t kNodes = 2 * kOdometryPiece + 3;
  TruePoses truth;
  std::vector<graph::Node> nodes(kNodes);
  for (std::uint32_t k = 0; k < kNodes; ++k) {
    nodes[k].id = node("r1", k);
    nodes[k].T_odom_base = at(4.1 * k, 0.0);
    nodes[k].odom_covariance = 0.01 * Matrix6d::Identity();
    truth[nodes[k].id] = at(4.0 * k, 3.0);
  }
  const auto errors = odometry_errors(nodes, truth);
  ASSERT_EQ(errors.size(), 2u) << "what is left at the end is no piece";
  for (const StatedError& one : errors) {
    EXPECT_NEAR(one.error[0], 0.1 * kOdometryPiece, 1e-9);
    EXPECT_NEAR(one.covariance(0, 0), 0.01 * kOdometryPiece, 1e-9);
    EXPECT_GT(one.covariance(1, 1), 0.01 * kOdometryPiece) << "headings swing what lies ahead";
  }
  nodes[5].odom_covariance.setZero();
  EXPECT_EQ(odometry_errors(nodes, truth).size(), 1u);
  for (std::uint32_t k = 10; k < kNodes; ++k) nodes[k].session = 1;
  EXPECT_EQ(odometry_errors(nodes, truth).size(), 1u);
  nodes[14].odom_covariance.setZero();
  EXPECT_TRUE(odometry_errors(nodes, truth).empty());
}

TEST(ObservedPlaces, AreThoseThatEnoughRobotsSawOftenEnough) {
  const auto points = [](float x, int count) {
    cloud::PointCloud cloud;
    for (int k = 0; k < count; ++k) cloud.points.emplace_back(x + 0.1f * static_cast<float>(k), 0.5f, -0.5f);
    return cloud;
  };
  ObservedPlaces places(1.0, 3);
  places.add(0, points(0.1f, 5));
  places.add(0, points(-2.9f, 5));
  places.add(1, points(0.1f, 2));
  EXPECT_EQ(places.count(1), 2u);
  EXPECT_EQ(places.count(2), 0u);
  places.add(1, points(0.5f, 1));
  places.add(1, points(std::numeric_limits<float>::quiet_NaN(), 4));
  EXPECT_EQ(places.count(2), 1u);
  cloud::PointCloud queries = points(0.05f, 3);
  cloud::append(queries, points(-2.95f, 4));
  EXPECT_EQ(places.within(queries, 2).size(), 3u);
  EXPECT_EQ(places.indices_within(queries, 1).size(), 7u);
}

}  // namespace
}  // namespace fleetmap::eval
