#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "placed_fleet.hpp"
#include "support/measured.hpp"

namespace fleetmap::graph {
namespace {

using fleetmap::testing::expect_at_most;
using fleetmap::testing::seeds_to_run;
using testing::count;
using testing::joint_error;
using testing::kR1;
using testing::kR2;
using testing::kR3;
using testing::of;
using testing::place;
using testing::SimulatedFleet;
using testing::statuses;

TEST(AbsurdNumbers, ARobotWhoseHeadingIsFalseDoesNotKeepTheOthersApart) {
  for (const double turn : {0.5, 1.0, M_PI}) {
    for (unsigned seed = 1; seed <= seeds_to_run(3); ++seed) {
      SimulatedFleet fleet(seed);
      for (Node& node : fleet.nodes) {
        if (node.id.agent == kR3)
          node.G->q_enu_base = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) * node.G->q_enu_base;
      }
      const Placement placement = place(fleet);
      EXPECT_GE(placement.alignment_stats.at(kR1).used, 4u) << turn << ' ' << of(seed);
      expect_at_most(joint_error(fleet, placement, {kR1, kR2}), 0.58, "joint error beside a false heading",
                     seed);
    }
  }
}

TEST(AbsurdNumbers, ImpossibleNumbersDoNotCount) {
  SimulatedFleet fleet(8);
  const Placement reference = place(fleet);
  const auto spoil = [&](const std::function<void(AlignmentMode&)>& how) {
    Alignment a = fleet.alignments.front();
    a.seq = 10'000 + static_cast<std::uint32_t>(fleet.alignments.size());
    how(a.modes.front());
    fleet.alignments.push_back(a);
  };
  spoil([](AlignmentMode& m) { m.T_i_j.translation().x() = std::nan(""); });
  spoil([](AlignmentMode& m) { m.T_i_j.translation().x() = 1e30; });
  spoil([](AlignmentMode& m) { m.T_i_j.linear() *= 2.0; });
  spoil([](AlignmentMode& m) { m.covariance(0, 0) = -1.0; });
  spoil([](AlignmentMode& m) { m.covariance(0, 1) = m.covariance(1, 0) = 1.0; });  // indefinite
  spoil([](AlignmentMode& m) { m.covariance(1, 2) = std::numeric_limits<double>::infinity(); });
  Node bad = fleet.nodes.front();
  bad.id.agent = AgentId::parse("x").value();
  bad.T_odom_base.translation().x() = 1e12;
  fleet.nodes.push_back(bad);
  bad.id.seq = 1;
  bad.T_odom_base = Pose::Identity();
  bad.G->covariance(0, 0) = std::nan("");
  fleet.nodes.push_back(bad);
  const Placement placement = place(fleet);
  EXPECT_EQ(count(placement, AlignmentStatus::invalid), 6u);
  EXPECT_EQ(placement.T_enu_node.size(), reference.T_enu_node.size());
  for (const auto& [id, T] : reference.T_enu_node)
    EXPECT_TRUE(T.matrix() == placement.T_enu_node.at(id).matrix()) << to_string(id);
}

TEST(AbsurdNumbers, ARobotOfAbsurdNumbersHurtsItselfAlone) {
  using Spoil = std::function<void(SimulatedFleet&, Node&)>;
  const auto anyhow = [](SimulatedFleet& fleet, double turn) {
    return so3_exp(Eigen::Vector3d(fleet.gauss(turn), fleet.gauss(turn), fleet.gauss(turn)));
  };
  const auto anywhere = [](SimulatedFleet& fleet, double metres) {
    return Eigen::Vector3d(fleet.gauss(metres), fleet.gauss(metres), fleet.gauss(1e3));
  };
  const Spoil wrong_motion = [&](SimulatedFleet& fleet, Node& node) {
    node.T_odom_base = make_pose(anyhow(fleet, 2.0), anywhere(fleet, 50.0));
    node.odom_covariance = 1e-18 * Matrix6d::Identity();
  };
  const Spoil far = [](SimulatedFleet&, Node& node) {
    node.G->position.latitude += 0.14;  // 900 km
    node.G->covariance = 1e-6 * Matrix6d::Identity();
  };
  const Spoil jumping = [&](SimulatedFleet& fleet, Node& node) {
    node.G->position = fleet.site.to_geo(anywhere(fleet, 1e5));
    node.G->covariance = 1e-6 * Matrix6d::Identity();
  };
  const Spoil all = [&](SimulatedFleet& fleet, Node& node) {
    wrong_motion(fleet, node);
    jumping(fleet, node);
    node.G->q_enu_base = Eigen::Quaterniond(anyhow(fleet, 2.0));
  };
  for (const Spoil& spoil : {wrong_motion, far, jumping, all}) {
    for (unsigned seed = 1; seed <= seeds_to_run(4); ++seed) {
      SimulatedFleet fleet(seed);
      for (Node& node : fleet.nodes)
        if (node.id.agent == kR3) spoil(fleet, node);
      const Placement placement = place(fleet);
      const auto status = statuses(placement);
      for (const Alignment& a : fleet.alignments) {
        const bool of_others = a.i.agent != kR3 && a.j.agent != kR3;
        EXPECT_EQ(status.at({a.computed_by, a.seq}) == AlignmentStatus::used, of_others) << of(seed);
      }
      expect_at_most(joint_error(fleet, placement, {kR1, kR2}), 0.58, "joint error beside absurd nodes",
                     seed);
      EXPECT_EQ(placement.components.size(), 2u) << of(seed);
      ASSERT_EQ(placement.T_enu_node.size(), fleet.nodes.size());
      for (const auto& [id, T] : placement.T_enu_node) EXPECT_TRUE(T.matrix().allFinite()) << to_string(id);
      std::ranges::shuffle(fleet.nodes, fleet.random());
      std::ranges::shuffle(fleet.alignments, fleet.random());
      const Placement shuffled = place(fleet);
      for (const auto& [id, T] : placement.T_enu_node)
        EXPECT_TRUE(T.matrix() == shuffled.T_enu_node.at(id).matrix()) << to_string(id);
    }
  }
}

}  // namespace
}  // namespace fleetmap::graph
