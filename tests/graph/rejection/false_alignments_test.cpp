#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

#include "graph/placed_fleet.hpp"
#include "support/measured.hpp"

namespace fleetmap::graph {
namespace {

using fleetmap::testing::expect_at_least;
using fleetmap::testing::expect_at_most;
using fleetmap::testing::seeds_to_run;
using testing::AlignmentName;
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

TEST(FalseAlignments, OneAlignmentOneRowOffIsRejected) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    SimulatedFleet fleet(seed);
    const double undisturbed = joint_error(fleet, place(fleet));
    const std::size_t honest = fleet.alignments.size();
    const auto pairs = fleet.near_pairs(kR1, kR2, 1);
    const auto& [i, j] = pairs[pairs.size() / 2];
    fleet.align(i, j, kR1, seed % 2 == 0 ? kOneRow : Eigen::Vector3d(-kOneRow));
    const Placement placement = place(fleet);
    expect_none_used(placement, names_from(fleet, honest), of(seed));
    EXPECT_NEAR(joint_error(fleet, placement), undisturbed, 0.05) << "seed " << seed;
  }
}

TEST(FalseAlignments, TenThatAgreeOneRowOffAreRejected) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    SimulatedFleet fleet(seed);
    const double undisturbed = joint_error(fleet, place(fleet));
    const std::size_t honest = fleet.alignments.size();
    const auto pairs = fleet.near_pairs(kR1, kR2, 1);
    ASSERT_GE(pairs.size(), 10u);
    for (std::size_t k = 0; k < 10; ++k) {
      const auto& [i, j] = pairs[k * pairs.size() / 10];
      fleet.align(i, j, k % 2 == 0 ? kR1 : kR2, kOneRow);
    }
    const Placement placement = place(fleet);
    expect_none_used(placement, names_from(fleet, honest), of(seed));
    EXPECT_NEAR(joint_error(fleet, placement), undisturbed, 0.05) << "seed " << seed;
  }
}

/// r1 and r3 meet as well, and all alignments of r1 and r2 are one row off. Returns their names.
std::set<AlignmentName> make_one_pair_false(SimulatedFleet& fleet) {
  std::set<AlignmentName> false_ones;
  for (Alignment& a : fleet.alignments) {
    if (std::set{a.i.agent, a.j.agent} != std::set{kR1, kR2}) continue;
    Pose T = fleet.truth.at(a.j);
    T.pretranslate(kOneRow);
    a.modes = {fleet.observed_at(a.i, T)};
    false_ones.emplace(a.computed_by, a.seq);
  }
  return false_ones;
}

SimulatedFleetConfig triangle(double length, double gps_sigma) {
  SimulatedFleetConfig config;
  config.reach = 50.0;
  config.lanes = 6;
  config.length = length;
  config.gps_sigma = gps_sigma;
  config.filtered = true;
  return config;
}

TEST(FalseAlignments, WhenAllBetweenTwoRobotsAreFalseAThirdTiesThem) {
  std::size_t apart = 0;
  const unsigned seeds = seeds_to_run(10);
  for (const double length : {80.0, 120.0, 160.0}) {
    for (unsigned seed = 1; seed <= seeds; ++seed) {
      SimulatedFleet fleet(seed, triangle(length, 1.5));
      const auto false_ones = make_one_pair_false(fleet);
      const Placement placement = place(fleet);
      expect_none_used(placement, false_ones, of(seed));
      apart += placement.components.size() > 1;
      if (placement.components.size() == 1) {
        expect_at_most(joint_error(fleet, placement), 1.2, "joint error, a false side of a triangle", seed);
      }
    }
  }
  // GPS may not tell which pair it is.
  expect_at_most(static_cast<double>(apart) / (3 * seeds), 0.1, "share of fleets left apart", seeds);
}

/// GPS cannot tell which side of the triangle is false: none of what it may be is taken, nor what fewer say
/// of the same robots, and none of it counts against who computed it.
TEST(FalseAlignments, PairsAreNotJoinedIfTheFalseOneCannotBeDetermined) {
  std::size_t apart = 0;
  for (unsigned seed = 0; seed < 10; ++seed) {
    SimulatedFleet fleet(seed, triangle(80.0, 5.0));
    const auto false_ones = make_one_pair_false(fleet);
    const std::size_t known = fleet.alignments.size();
    const auto pairs = fleet.near_pairs(kR2, kR3, 7);
    for (std::size_t k = 0; k < 2; ++k) fleet.align(pairs[k].first, pairs[k].second, kR2, -kOneRow);
    const Placement placement = place(fleet);
    expect_none_used(placement, false_ones, of(seed));
    expect_none_used(placement, names_from(fleet, known), of(seed));
    for (const auto& [agent, credit] : placement.alignment_stats)
      EXPECT_FALSE(credit.quarantined) << agent.str();
    if (placement.components.size() != 3) continue;
    ++apart;
    const auto status = statuses(placement);
    for (const auto& name : false_ones) EXPECT_EQ(status.at(name), AlignmentStatus::undecided) << of(seed);
  }
  EXPECT_GT(apart, 5u);
}

/// Two of five alignments along the way are true and agree; each has more neighbours against it than for it.
TEST(FalseAlignments, VotesThatRejectEveryNeighbourDecideNothing) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    SimulatedFleetConfig config;
    config.robots = 2;
    config.reach = 0.0;
    SimulatedFleet fleet(seed, config);
    SimulatedFleetConfig near = config;
    near.reach = 14.0;
    const auto pairs = SimulatedFleet(seed, near).near_pairs(kR1, kR2, 2);
    ASSERT_GE(pairs.size(), 5u);
    const std::array<Eigen::Vector3d, 5> shifts{Eigen::Vector3d(3.0, 2.0, 0.0), Eigen::Vector3d::Zero(),
                                                Eigen::Vector3d(-2.0, -4.0, 0.0), Eigen::Vector3d::Zero(),
                                                Eigen::Vector3d(0.0, 5.0, 0.0)};
    for (std::size_t k = 0; k < shifts.size(); ++k)
      fleet.align(pairs[k].first, pairs[k].second, kR1, shifts[k]);
    const Placement placement = place(fleet);
    EXPECT_EQ(placement.used.size(), 2u) << of(seed);
    EXPECT_EQ(placement.components.size(), 1u) << of(seed);
  }
}

/// With one mode an alignment, and with two.
TEST(FalseAlignments, ARobotThatComputesGarbageIsQuarantinedAndBendsNothing) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    SimulatedFleetConfig config;
    config.robots = 4;
    config.reach = 40.0;
    SimulatedFleet fleet(seed, config);
    const AgentId faulty = SimulatedFleet::agent(3);
    const std::set<AgentId> others{kR1, kR2, kR3};
    std::erase_if(fleet.alignments,
                  [&](const Alignment& a) { return a.i.agent == faulty || a.j.agent == faulty; });
    const double undisturbed = joint_error(fleet, place(fleet), others);
    for (const AgentId& other : others) {
      for (const auto& [i, j] : fleet.near_pairs(faulty, other, 2)) {
        Alignment& a = fleet.align(i, j, faulty);
        a.seq += 1000;
        a.modes.resize(1 + seed % 2, a.modes.front());
        for (AlignmentMode& mode : a.modes) {
          Vector6d garbage;
          for (int k = 0; k < 6; ++k) garbage(k) = fleet.gauss(k < 3 ? 8.0 : 0.5);
          mode.T_i_j = mode.T_i_j * se3_exp(garbage);
        }
      }
    }
    const Placement placement = place(fleet);
    EXPECT_TRUE(placement.alignment_stats.at(faulty).quarantined) << "seed " << seed;
    EXPECT_EQ(placement.alignment_stats.at(faulty).used, 0u);
    for (const AgentId& other : others) EXPECT_FALSE(placement.alignment_stats.at(other).quarantined);
    EXPECT_NEAR(joint_error(fleet, placement, others), undisturbed, 0.02) << "seed " << seed;
  }
}

TEST(FalseAlignments, ModesOfAmbiguousAlignmentsAreToldApart) {
  std::size_t right = 0, wrong = 0, all = 0;
  const unsigned seeds = seeds_to_run(10);
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    SimulatedFleet fleet(seed);
    for (Alignment& a : fleet.alignments) {
      if (fleet.random()() % 2 == 0) continue;
      for (const double rows : {-1.0, 1.0, 2.0}) {
        Pose T = fleet.truth.at(a.j);
        T.pretranslate(rows * kOneRow);
        a.modes.insert(a.modes.begin(), fleet.observed_at(a.i, T));
      }
    }
    const Placement placement = place(fleet);
    for (const AlignmentOutcome& one : placement.outcomes) {
      const auto& a = *std::ranges::find_if(fleet.alignments, [&](const Alignment& other) {
        return other.computed_by == one.computed_by && other.seq == one.seq;
      });
      if (!a.ambiguous()) continue;
      ++all;
      if (one.status == AlignmentStatus::used) ++(one.mode == 3 ? right : wrong);
    }
  }
  EXPECT_EQ(wrong, 0u);
  expect_at_least(static_cast<double>(right) / static_cast<double>(all), 0.99, "ambiguous ones told apart",
                  seeds);
}

/// A pose that few points fit is stated with metres of uncertainty, so it fits wherever the right one does.
TEST(FalseAlignments, AModeThatSaysLittleIsNotTakenForTheOneThatSaysMuch) {
  for (unsigned seed = 1; seed <= seeds_to_run(5); ++seed) {
    SimulatedFleet fleet(seed);
    for (Alignment& a : fleet.alignments) {
      if (fleet.random()() % 3 != 0) continue;
      Pose T = fleet.truth.at(a.j);
      T.pretranslate(Eigen::Vector3d(3.0, 0.0, 0.0));
      a.modes.push_back(fleet.observed_at(a.i, T));
      a.modes.back().covariance =
          Vector6d(100.0, 100.0, 100.0, 0.67, 0.67, 0.67).asDiagonal();  // as a registration without a hold
      Pose blurred = fleet.truth.at(a.j);
      blurred.pretranslate(Eigen::Vector3d(0.0, 1.0, 0.0));
      a.modes.push_back(fleet.observed_at(a.i, blurred));
      a.modes.back().covariance = Vector6d(1.0, 1.0, 1.0, 0.01, 0.01, 0.01).asDiagonal();
    }
    std::size_t right = 0;
    for (const AlignmentOutcome& one : place(fleet).outcomes) {
      if (one.status != AlignmentStatus::used) continue;
      EXPECT_EQ(one.mode, 0u) << "seed " << seed;
      ++right;
    }
    expect_at_least(static_cast<double>(right) / static_cast<double>(fleet.alignments.size()), 0.99,
                    "used beside modes that say little", seed);
  }
}

TEST(FalseAlignments, AnAmbiguousAlignmentAllOfWhoseModesAreContradictedIsRejected) {
  for (const double near : {1.5, 2.5, 4.0}) {
    SimulatedFleet fleet(1);
    const Alignment base = fleet.alignments[fleet.alignments.size() / 2];
    Alignment& a = fleet.align(base.i, base.j, kR1, Eigen::Vector3d(100.0, 0.0, 0.0));
    Pose T = fleet.truth.at(base.j);
    T.pretranslate(Eigen::Vector3d(near, 0.0, 0.0));
    a.modes.push_back(fleet.observed_at(base.i, T));
    EXPECT_EQ(statuses(place(fleet)).at({kR1, a.seq}), AlignmentStatus::against_others) << near;
  }
}

TEST(FalseAlignments, LongMissionWithTwentyPercentFalseUsesExactlyTheTrueOnes) {
  for (unsigned seed = 1; seed <= seeds_to_run(3); ++seed) {
    SimulatedFleet fleet(seed, testing::long_mission(4, 700));
    const auto false_ones = fleet.align_neighbours(8, 0.2);
    EXPECT_GT(false_ones.size() * 8, fleet.alignments.size());
    const Placement placement = place(fleet);
    expect_none_used(placement, false_ones, of(seed));
    EXPECT_GE(placement.used.size() * 100, (fleet.alignments.size() - false_ones.size()) * 99) << of(seed);
    expect_at_most(joint_error(fleet, placement), 0.8, "joint error, one in five false", seed);
    std::ranges::shuffle(fleet.nodes, fleet.random());
    std::ranges::shuffle(fleet.alignments, fleet.random());
    const Placement shuffled = place(fleet);
    for (const auto& [id, T] : placement.T_enu_node)
      EXPECT_TRUE(T.matrix() == shuffled.T_enu_node.at(id).matrix()) << to_string(id);
    EXPECT_EQ(statuses(placement), statuses(shuffled));
  }
}

/// If GPS is so poor that almost any alignments agree, the votes of neighbours reject the false ones.
TEST(FalseAlignments, LongMissionAtFiveMetresOfGpsUsesExactlyTheTrueOnes) {
  for (const unsigned seed : {1u, 3u}) {
    SimulatedFleetConfig config = testing::long_mission(5, 2000);
    config.filtered = true;
    config.gps_sigma = 5.0;
    SimulatedFleet fleet(seed, config);
    const auto false_ones = fleet.align_neighbours(10, 0.2);
    const Placement placement = place(fleet);
    expect_none_used(placement, false_ones, of(seed));
    EXPECT_GE(placement.used.size() * 100, (fleet.alignments.size() - false_ones.size()) * 99) << of(seed);
  }
}

TEST(FalseAlignments, AFalseLoopClosureDoesNotBendItsRobot) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    SimulatedFleet fleet(seed);
    const std::size_t honest = fleet.alignments.size();
    fleet.align({kR1, 5}, {kR1, 25}, kR1);
    fleet.align({kR1, 8}, {kR1, 24}, kR1, kOneRow);
    const Placement placement = place(fleet);
    EXPECT_EQ(statuses(placement).at({kR1, fleet.alignments[honest].seq}), AlignmentStatus::used);
    EXPECT_NE(statuses(placement).at({kR1, fleet.alignments[honest + 1].seq}), AlignmentStatus::used);
  }
}

}  // namespace
}  // namespace fleetmap::graph
