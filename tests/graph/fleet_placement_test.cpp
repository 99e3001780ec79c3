#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "paper_placement.hpp"
#include "placed_fleet.hpp"
#include "support/measured.hpp"

namespace fleetmap::graph {
namespace {

using fleetmap::testing::expect_at_most;
using fleetmap::testing::seeds_to_run;
using testing::count;
using testing::expect_none_used;
using testing::joint_error;
using testing::kOneRow;
using testing::kR1;
using testing::kR2;
using testing::kR3;
using testing::names_from;
using testing::of;
using testing::place;
using testing::SimulatedFleet;
using testing::SimulatedFleetConfig;
using testing::statuses;

TEST(FleetPlacement, AllTrueAlignmentsAreUsedAndTieTheFleet) {
  for (unsigned seed = 1; seed <= seeds_to_run(10); ++seed) {
    const SimulatedFleet fleet(seed);
    const Placement placement = place(fleet);
    EXPECT_EQ(placement.components.size(), 1u) << "seed " << seed;
    EXPECT_GE(placement.used.size() * 100, fleet.alignments.size() * 97) << "seed " << seed;
    EXPECT_EQ(placement.T_enu_node.size(), fleet.nodes.size());
    expect_at_most(joint_error(fleet, placement), 0.63, "joint error, true alignments", seed);
    for (const auto& [agent, credit] : placement.alignment_stats) EXPECT_FALSE(credit.quarantined);
  }
}

TEST(FleetPlacement, BetterThanTheLeastRmseOfThePaper) {
  double fleet_error = 0.0, paper_error = 0.0;
  const unsigned seeds = seeds_to_run(10);
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    const SimulatedFleet fleet(seed);
    fleet_error += joint_error(fleet, place(fleet));
    paper_error += joint_error(fleet, place_by_min_rmse(fleet.nodes, fleet.alignments, fleet.site));
  }
  expect_at_most(fleet_error / paper_error, 0.61, "joint error over that of the paper", seeds);
}

TEST(FleetPlacement, FixesOfCentimetresDecideOverAWrongHeading) {
  SimulatedFleetConfig config;
  config.robots = 1;
  config.gps_sigma = 0.02;
  config.yaw_sigma = 2.5 * testing::kDegree;
  for (unsigned seed = 1; seed <= seeds_to_run(3); ++seed) {
    SimulatedFleet fleet(seed, config);
    // The headings of a filter err alike: a constant error of one sigma besides the simulated one.
    const Eigen::Quaterniond turned(Eigen::AngleAxisd(2.5 * testing::kDegree, Eigen::Vector3d::UnitZ()));
    for (Node& node : fleet.nodes) node.G->q_enu_base = turned * node.G->q_enu_base;
    const Placement placement = place(fleet);
    double squares = 0.0;
    for (const auto& [id, T] : placement.T_enu_node)
      squares += (T.translation() - fleet.truth.at(id).translation()).head<2>().squaredNorm();
    expect_at_most(std::sqrt(squares / static_cast<double>(placement.T_enu_node.size())), 0.124,
                   "place of nodes with RTK, m", seed);
  }
}

TEST(FleetPlacement, SameSetSameBitsWhateverTheOrder) {
  SimulatedFleet fleet(3);
  for (const auto& [i, j] : fleet.near_pairs(kR1, kR2, 5)) fleet.align(i, j, kR1, kOneRow);
  for (const auto& [i, j] : fleet.near_pairs(kR2, kR3, 7)) {
    Alignment& a = fleet.align(i, j, kR3, kOneRow);
    a.modes.push_back(fleet.observed_at(i, fleet.truth.at(j)));
  }
  std::vector<NodeId> all;
  for (const Node& node : fleet.nodes) all.push_back(node.id);
  const Placement reference = place(fleet, all);
  for (int shuffle = 0; shuffle < 5; ++shuffle) {
    std::ranges::shuffle(fleet.nodes, fleet.random());
    std::ranges::shuffle(fleet.alignments, fleet.random());
    const Placement placement = place(fleet, all);
    ASSERT_EQ(placement.T_enu_node.size(), reference.T_enu_node.size());
    for (const auto& [id, T] : reference.T_enu_node) {
      EXPECT_TRUE(T.matrix() == placement.T_enu_node.at(id).matrix()) << to_string(id);
      EXPECT_TRUE(reference.covariance.at(id) == placement.covariance.at(id)) << to_string(id);
    }
    for (const auto& [frame, T] : reference.T_enu_odom)
      EXPECT_TRUE(T.matrix() == placement.T_enu_odom.at(frame).matrix());
    EXPECT_EQ(statuses(placement), statuses(reference));
    EXPECT_EQ(placement.components, reference.components);
  }
}

TEST(FleetPlacement, GpsOutageOfThreeMinutes) {
  for (unsigned seed = 1; seed <= seeds_to_run(5); ++seed) {
    SimulatedFleet fleet(seed);
    for (Node& node : fleet.nodes) {
      const double seconds = 4.0 * node.id.seq;
      if (node.id.agent != kR2 || seconds < 40.0 || seconds > 220.0) continue;
      // Dead reckoning: an error that grows, and is known to.
      const double sigma = 1.5 + 0.1 * (seconds - 40.0);
      node.G->position.longitude += 0.7 * sigma / 4.95e6;
      node.G->covariance.diagonal().head<3>().setConstant(sigma * sigma);
    }
    const std::size_t honest = fleet.alignments.size();
    const auto pairs = fleet.near_pairs(kR1, kR2, 1);
    fleet.align(pairs[3].first, pairs[3].second, kR1, kOneRow);
    const Placement placement = place(fleet);
    expect_none_used(placement, names_from(fleet, honest), of(seed));
    expect_at_most(joint_error(fleet, placement), 0.58, "joint error, GPS outage", seed);
  }
}

TEST(FleetPlacement, GpsOfTenMetresLeavesItToTheMajority) {
  for (unsigned seed = 1; seed <= seeds_to_run(10); ++seed) {
    SimulatedFleetConfig config;
    config.gps_sigma = 10.0;
    SimulatedFleet fleet(seed, config);
    const std::size_t honest = fleet.alignments.size();
    const auto pairs = fleet.near_pairs(kR1, kR2, 1);
    fleet.align(pairs[3].first, pairs[3].second, kR1, kOneRow);
    const Placement placement = place(fleet);
    expect_none_used(placement, names_from(fleet, honest), of(seed));
    EXPECT_EQ(placement.components.size(), 1u);
    expect_at_most(joint_error(fleet, placement), 0.70, "joint error, GPS of 10 m", seed);
  }
}

TEST(FleetPlacement, AlignmentsAloneJoinTheFleetIfGpsIsWeakOrLost) {
  for (const double sigma : {10.0, 30.0, 100.0, 1000.0}) {
    for (unsigned seed = 1; seed <= seeds_to_run(8); ++seed) {
      SimulatedFleetConfig config;
      config.gps_sigma = sigma;
      SimulatedFleet fleet(seed, config);
      const Placement placement = place(fleet);
      const std::string what = of(seed).append(", sigma ").append(std::to_string(sigma));
      EXPECT_EQ(placement.used.size(), fleet.alignments.size()) << what;
      expect_at_most(joint_error(fleet, placement), 0.72, "joint error, GPS of 10 m and worse", seed);
      for (const Node& node : fleet.nodes)
        EXPECT_LT(
            (placement.T_enu_node.at(node.id).translation() - fleet.truth.at(node.id).translation()).norm(),
            2.0 * sigma)
            << what;
      std::ranges::shuffle(fleet.nodes, fleet.random());
      std::ranges::shuffle(fleet.alignments, fleet.random());
      const Placement shuffled = place(fleet);
      for (const auto& [id, T] : placement.T_enu_node)
        EXPECT_TRUE(T.matrix() == shuffled.T_enu_node.at(id).matrix()) << what << ' ' << to_string(id);
    }
  }
}

TEST(FleetPlacement, AKidnappedRobotIsAFrameOfItsOwnUntilAlignedWithAnother) {
  SimulatedFleet fleet(5);
  std::erase_if(fleet.alignments, [](const Alignment& a) {
    return (a.i.agent == kR1 && a.i.seq >= 30) || (a.j.agent == kR1 && a.j.seq >= 30);
  });
  fleet.kidnap(kR1, 30);
  const Placement apart = place(fleet);
  EXPECT_EQ(apart.components.size(), 3u);
  EXPECT_EQ(apart.T_enu_odom.size(), 4u);
  fleet.align({kR1, 12}, {kR1, 40}, kR1);  // with itself, before
  fleet.align({kR1, 20}, {kR1, 50}, kR1);
  const Placement joined = place(fleet);
  EXPECT_EQ(joined.components.size(), 2u);
  EXPECT_LT(joint_error(fleet, joined, {kR1}), 0.6);
}

TEST(FleetPlacement, WithoutAlignmentsEveryFrameLiesWhereItsGpsSays) {
  SimulatedFleet fleet(6);
  fleet.alignments.clear();
  const Placement placement = place(fleet);
  EXPECT_EQ(placement.components.size(), 3u);
  for (const Node& node : fleet.nodes) {
    EXPECT_LT((placement.T_enu_node.at(node.id).translation() - fleet.truth.at(node.id).translation()).norm(),
              4.0 * 1.5);
  }
  EXPECT_TRUE(place_by_fleet_graph({}, {}, fleet.site).T_enu_node.empty());
}

TEST(FleetPlacement, ALoneNodeIsPlaced) {
  SimulatedFleet fleet(7);
  fleet.nodes.resize(1);
  const Placement placement = place(fleet);
  ASSERT_EQ(placement.T_enu_node.size(), 1u);
  EXPECT_EQ(count(placement, AlignmentStatus::waiting), fleet.alignments.size());
}

}  // namespace
}  // namespace fleetmap::graph
