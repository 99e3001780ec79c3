#include "fleetmap/graph/fleet_placement.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <functional>
#include <limits>
#include <set>

#include "simulated_fleet.hpp"

namespace fleetmap::graph {
namespace {

using testing::kPitch;
using testing::SimulatedFleet;
using testing::SimulatedFleetConfig;

const Eigen::Vector3d kOneRow(kPitch, 0.0, 0.0);
const AgentId kR1 = SimulatedFleet::agent(0), kR2 = SimulatedFleet::agent(1), kR3 = SimulatedFleet::agent(2);

std::string of(unsigned seed) { return std::string("seed ").append(std::to_string(seed)); }

Placement place(const SimulatedFleet& fleet, std::span<const NodeId> covariance_of = {}) {
  return place_by_fleet_graph(fleet.nodes, fleet.alignments, fleet.site, {}, covariance_of);
}

/// RMS error of the positions of all nodes of `agents` (all, if empty), as one rigid body: what of the map is
/// bent.
double joint_error(const SimulatedFleet& fleet, const Placement& placement,
                   const std::set<AgentId>& agents = {}) {
  std::vector<Eigen::Vector3d> placed, true_place;
  for (const auto& [id, T] : fleet.truth) {
    if (!agents.empty() && !agents.contains(id.agent)) continue;
    placed.push_back(placement.T_enu_node.at(id).translation());
    true_place.push_back(T.translation());
  }
  const auto n = static_cast<Eigen::Index>(placed.size());
  const Eigen::Map<const Eigen::Matrix3Xd> A(placed.front().data(), 3, n), B(true_place.front().data(), 3, n);
  const Eigen::Matrix4d T = Eigen::umeyama(A, B, false);
  const Eigen::Matrix3Xd moved = (T.topLeftCorner<3, 3>() * A).colwise() + T.topRightCorner<3, 1>();
  return std::sqrt((moved - B).squaredNorm() / static_cast<double>(n));
}

std::map<std::pair<AgentId, std::uint32_t>, Judgement> judgements(const Placement& placement) {
  std::map<std::pair<AgentId, std::uint32_t>, Judgement> result;
  for (const JudgedAlignment& one : placement.judged) result[{one.computed_by, one.seq}] = one.judgement;
  return result;
}

std::size_t count(const Placement& placement, Judgement judgement) {
  return static_cast<std::size_t>(
      std::ranges::count(placement.judged, judgement, &JudgedAlignment::judgement));
}

/// Names of the alignments from the k-th on.
std::set<std::pair<AgentId, std::uint32_t>> names_from(const SimulatedFleet& fleet, std::size_t first) {
  std::set<std::pair<AgentId, std::uint32_t>> names;
  for (std::size_t k = first; k < fleet.alignments.size(); ++k)
    names.emplace(fleet.alignments[k].computed_by, fleet.alignments[k].seq);
  return names;
}

void expect_none_used(const Placement& placement, const std::set<std::pair<AgentId, std::uint32_t>>& names,
                      const std::string& what) {
  for (const auto& [name, judgement] : judgements(placement)) {
    if (names.contains(name)) {
      EXPECT_NE(judgement, Judgement::used) << what << ": " << name.first.str() << '/' << name.second;
    }
  }
}

TEST(FleetPlacement, AllTrueAlignmentsAreUsedAndTieTheFleet) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const SimulatedFleet fleet(seed);
    const Placement placement = place(fleet);
    EXPECT_EQ(placement.components.size(), 1u) << "seed " << seed;
    EXPECT_GE(placement.used.size() * 100, fleet.alignments.size() * 97) << "seed " << seed;
    EXPECT_EQ(placement.T_enu_node.size(), fleet.nodes.size());
    EXPECT_LT(joint_error(fleet, placement), 0.8) << "seed " << seed;
    for (const auto& [agent, credit] : placement.credits) EXPECT_FALSE(credit.quarantined);
  }
}

TEST(FleetPlacement, BetterThanTheLeastRmseOfThePaper) {
  double fleet_error = 0.0, paper_error = 0.0;
  for (unsigned seed = 0; seed < 10; ++seed) {
    const SimulatedFleet fleet(seed);
    fleet_error += joint_error(fleet, place(fleet));
    paper_error += joint_error(fleet, place_by_least_rmse(fleet.nodes, fleet.alignments, fleet.site));
  }
  EXPECT_LT(fleet_error, 0.7 * paper_error);
}

TEST(FleetPlacement, SameSetSameBitsWhateverTheOrder) {
  SimulatedFleet fleet(3);
  for (const auto& [i, j] : fleet.near_pairs(kR1, kR2, 5)) fleet.align(i, j, kR1, kOneRow);
  for (const auto& [i, j] : fleet.near_pairs(kR2, kR3, 7)) {
    Alignment& a = fleet.align(i, j, kR3, kOneRow);
    a.modes.push_back(fleet.seen_at(i, fleet.truth.at(j)));
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
    EXPECT_EQ(judgements(placement), judgements(reference));
    EXPECT_EQ(placement.components, reference.components);
  }
}

TEST(FleetPlacement, OneAlignmentOneRowOffIsRejected) {
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

TEST(FleetPlacement, TenThatAgreeOneRowOffAreRejected) {
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
std::set<std::pair<AgentId, std::uint32_t>> make_one_pair_false(SimulatedFleet& fleet) {
  std::set<std::pair<AgentId, std::uint32_t>> false_ones;
  for (Alignment& a : fleet.alignments) {
    if (std::set{a.i.agent, a.j.agent} != std::set{kR1, kR2}) continue;
    Pose T = fleet.truth.at(a.j);
    T.pretranslate(kOneRow);
    a.modes = {fleet.seen_at(a.i, T)};
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

TEST(FleetPlacement, WhenAllBetweenTwoRobotsAreFalseAThirdTiesThem) {
  std::size_t apart = 0;
  for (const double length : {80.0, 120.0, 160.0}) {
    for (unsigned seed = 0; seed < 10; ++seed) {
      SimulatedFleet fleet(seed, triangle(length, 1.5));
      const auto false_ones = make_one_pair_false(fleet);
      const Placement placement = place(fleet);
      expect_none_used(placement, false_ones, of(seed));
      apart += placement.components.size() > 1;
      if (placement.components.size() == 1) {
        EXPECT_LT(joint_error(fleet, placement), 1.2) << of(seed);
      }
    }
  }
  EXPECT_LE(apart, 3u);  // GPS may not tell which pair it is
}

/// GPS cannot tell which side of the triangle is false: none of what it may be is taken, nor what fewer say
/// of the same robots, and none of it counts against who computed it.
TEST(FleetPlacement, WhereLuckWouldDecideWhichPairIsFalseNoneOfThemIsTied) {
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
    for (const auto& [agent, credit] : placement.credits) EXPECT_FALSE(credit.quarantined) << agent.str();
    if (placement.components.size() != 3) continue;
    ++apart;
    const auto judged = judgements(placement);
    for (const auto& name : false_ones) EXPECT_EQ(judged.at(name), Judgement::undecided) << of(seed);
  }
  EXPECT_GT(apart, 5u);
}

/// Of five along the way two are right and agree; each has more neighbours against it than for it.
TEST(FleetPlacement, WhereNeighboursOutvoteAllTheyDecideNothing) {
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
TEST(FleetPlacement, ARobotThatComputesGarbageIsQuarantinedAndBendsNothing) {
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
    EXPECT_TRUE(placement.credits.at(faulty).quarantined) << "seed " << seed;
    EXPECT_EQ(placement.credits.at(faulty).used, 0u);
    for (const AgentId& other : others) EXPECT_FALSE(placement.credits.at(other).quarantined);
    EXPECT_NEAR(joint_error(fleet, placement, others), undisturbed, 0.02) << "seed " << seed;
  }
}

TEST(FleetPlacement, ModesOfAmbiguousAlignmentsAreToldApart) {
  std::size_t right = 0, wrong = 0, all = 0;
  for (unsigned seed = 0; seed < 10; ++seed) {
    SimulatedFleet fleet(seed);
    for (Alignment& a : fleet.alignments) {
      if (fleet.random()() % 2 == 0) continue;
      for (const double rows : {-1.0, 1.0, 2.0}) {
        Pose T = fleet.truth.at(a.j);
        T.pretranslate(rows * kOneRow);
        a.modes.insert(a.modes.begin(), fleet.seen_at(a.i, T));
      }
    }
    const Placement placement = place(fleet);
    for (const JudgedAlignment& one : placement.judged) {
      const auto& a = *std::ranges::find_if(fleet.alignments, [&](const Alignment& other) {
        return other.computed_by == one.computed_by && other.seq == one.seq;
      });
      if (!a.ambiguous()) continue;
      ++all;
      if (one.judgement == Judgement::used) ++(one.mode == 3 ? right : wrong);
    }
  }
  EXPECT_EQ(wrong, 0u);
  EXPECT_GT(right * 100, all * 90);
}

/// A pose that few points fit is stated with metres of uncertainty, so it fits wherever the right one does.
TEST(FleetPlacement, AModeThatSaysLittleIsNotTakenForTheOneThatSaysMuch) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    SimulatedFleet fleet(seed);
    for (Alignment& a : fleet.alignments) {
      if (fleet.random()() % 3 != 0) continue;
      Pose T = fleet.truth.at(a.j);
      T.pretranslate(Eigen::Vector3d(3.0, 0.0, 0.0));
      a.modes.push_back(fleet.seen_at(a.i, T));
      a.modes.back().covariance =
          Vector6d(100.0, 100.0, 100.0, 0.67, 0.67, 0.67).asDiagonal();  // as a registration without a hold
      Pose blurred = fleet.truth.at(a.j);
      blurred.pretranslate(Eigen::Vector3d(0.0, 1.0, 0.0));
      a.modes.push_back(fleet.seen_at(a.i, blurred));
      a.modes.back().covariance = Vector6d(1.0, 1.0, 1.0, 0.01, 0.01, 0.01).asDiagonal();
    }
    std::size_t right = 0;
    for (const JudgedAlignment& one : place(fleet).judged) {
      if (one.judgement != Judgement::used) continue;
      EXPECT_EQ(one.mode, 0u) << "seed " << seed;
      ++right;
    }
    EXPECT_GT(right * 10, fleet.alignments.size() * 9);
  }
}

TEST(FleetPlacement, AnAmbiguousAlignmentAllOfWhoseModesAreContradictedIsRejected) {
  for (const double near : {1.5, 2.5, 4.0}) {
    SimulatedFleet fleet(1);
    const Alignment base = fleet.alignments[fleet.alignments.size() / 2];
    Alignment& a = fleet.align(base.i, base.j, kR1, Eigen::Vector3d(100.0, 0.0, 0.0));
    Pose T = fleet.truth.at(base.j);
    T.pretranslate(Eigen::Vector3d(near, 0.0, 0.0));
    a.modes.push_back(fleet.seen_at(base.i, T));
    EXPECT_EQ(judgements(place(fleet)).at({kR1, a.seq}), Judgement::against_others) << near;
  }
}

TEST(FleetPlacement, ARobotWhoseHeadingIsFalseDoesNotKeepTheOthersApart) {
  for (const double turn : {0.5, 1.0, M_PI}) {
    SimulatedFleet fleet(2);
    for (Node& node : fleet.nodes) {
      if (node.id.agent == kR3)
        node.G->q_enu_base = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) * node.G->q_enu_base;
    }
    const Placement placement = place(fleet);
    EXPECT_GE(placement.credits.at(kR1).used, 4u) << turn;
    EXPECT_LT(joint_error(fleet, placement, {kR1, kR2}), 0.8) << turn;
  }
}

TEST(FleetPlacement, OfALongMissionWithOneInFiveFalseAllTrueAndNoFalseOnesAreUsed) {
  for (unsigned seed = 0; seed < 3; ++seed) {
    SimulatedFleet fleet(seed, testing::long_mission(4, 700));
    const auto false_ones = fleet.align_neighbours(8, 0.2);
    EXPECT_GT(false_ones.size() * 8, fleet.alignments.size());
    const Placement placement = place(fleet);
    expect_none_used(placement, false_ones, of(seed));
    EXPECT_GE(placement.used.size() * 100, (fleet.alignments.size() - false_ones.size()) * 99) << of(seed);
    EXPECT_LT(joint_error(fleet, placement), 0.8) << of(seed);
    std::ranges::shuffle(fleet.nodes, fleet.random());
    std::ranges::shuffle(fleet.alignments, fleet.random());
    const Placement shuffled = place(fleet);
    for (const auto& [id, T] : placement.T_enu_node)
      EXPECT_TRUE(T.matrix() == shuffled.T_enu_node.at(id).matrix()) << to_string(id);
    EXPECT_EQ(judgements(placement), judgements(shuffled));
  }
}

/// Where GPS lets almost anything agree with anything, neighbours along the way outvote the false ones.
TEST(FleetPlacement, OfALongMissionAtFiveMetresOfGpsOneInFiveFalseAllTrueAndNoFalseOnesAreUsed) {
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

TEST(FleetPlacement, GpsOutageOfThreeMinutes) {
  for (unsigned seed = 0; seed < 5; ++seed) {
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
    EXPECT_LT(joint_error(fleet, placement), 0.6) << "seed " << seed;
  }
}

TEST(FleetPlacement, GpsOfTenMetresLeavesItToTheMajority) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    SimulatedFleetConfig config;
    config.gps_sigma = 10.0;
    SimulatedFleet fleet(seed, config);
    const std::size_t honest = fleet.alignments.size();
    const auto pairs = fleet.near_pairs(kR1, kR2, 1);
    fleet.align(pairs[3].first, pairs[3].second, kR1, kOneRow);
    const Placement placement = place(fleet);
    expect_none_used(placement, names_from(fleet, honest), of(seed));
    EXPECT_EQ(placement.components.size(), 1u);
    EXPECT_LT(joint_error(fleet, placement), 1.0) << "seed " << seed;
  }
}

TEST(FleetPlacement, OfWeakOrLostGpsTheAlignmentsAloneTieTheFleet) {
  for (const double sigma : {10.0, 30.0, 100.0, 1000.0}) {
    for (unsigned seed = 1; seed <= 8; ++seed) {
      SimulatedFleetConfig config;
      config.gps_sigma = sigma;
      SimulatedFleet fleet(seed, config);
      const Placement placement = place(fleet);
      const std::string what = of(seed).append(", sigma ").append(std::to_string(sigma));
      EXPECT_EQ(placement.used.size(), fleet.alignments.size()) << what;
      EXPECT_LT(joint_error(fleet, placement), 0.8) << what;
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
  const Placement tied = place(fleet);
  EXPECT_EQ(tied.components.size(), 2u);
  EXPECT_LT(joint_error(fleet, tied, {kR1}), 0.6);
}

TEST(FleetPlacement, AFalseLoopClosureDoesNotBendItsRobot) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    SimulatedFleet fleet(seed);
    const std::size_t honest = fleet.alignments.size();
    fleet.align({kR1, 5}, {kR1, 25}, kR1);
    fleet.align({kR1, 8}, {kR1, 24}, kR1, kOneRow);
    const Placement placement = place(fleet);
    EXPECT_EQ(judgements(placement).at({kR1, fleet.alignments[honest].seq}), Judgement::used);
    EXPECT_NE(judgements(placement).at({kR1, fleet.alignments[honest + 1].seq}), Judgement::used);
  }
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
  EXPECT_EQ(count(placement, Judgement::waiting), fleet.alignments.size());
}

TEST(FleetPlacement, ImpossibleNumbersDoNotCount) {
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
  EXPECT_EQ(count(placement, Judgement::invalid), 6u);
  EXPECT_EQ(placement.T_enu_node.size(), reference.T_enu_node.size());
  for (const auto& [id, T] : reference.T_enu_node)
    EXPECT_TRUE(T.matrix() == placement.T_enu_node.at(id).matrix()) << to_string(id);
}

TEST(FleetPlacement, ARobotOfAbsurdNumbersHurtsItselfAlone) {
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
    for (unsigned seed = 0; seed < 4; ++seed) {
      SimulatedFleet fleet(seed);
      for (Node& node : fleet.nodes)
        if (node.id.agent == kR3) spoil(fleet, node);
      const Placement placement = place(fleet);
      const auto judged = judgements(placement);
      for (const Alignment& a : fleet.alignments) {
        const bool of_others = a.i.agent != kR3 && a.j.agent != kR3;
        EXPECT_EQ(judged.at({a.computed_by, a.seq}) == Judgement::used, of_others) << of(seed);
      }
      EXPECT_LT(joint_error(fleet, placement, {kR1, kR2}), 0.8) << of(seed);
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

TEST(FleetPlacement, CovariancesPromiseWhatErrorsAre) {
  double sum = 0.0, ends = 0.0;
  int samples = 0, end_samples = 0;
  for (unsigned seed = 100; seed < 130; ++seed) {
    const SimulatedFleet fleet(seed);
    std::vector<NodeId> some;
    for (const Node& node : fleet.nodes) {
      if (node.id.seq % 9 == 4 || node.id.seq == 60) some.push_back(node.id);
    }
    const Placement placement = place(fleet, some);
    for (const NodeId& id : some) {
      const Vector6d error = se3_log(placement.T_enu_node.at(id).inverse() * fleet.truth.at(id));
      const double nees = error.dot(placement.covariance.at(id).llt().solve(error)) / 6.0;
      (id.seq == 60 ? ends : sum) += nees;
      ++(id.seq == 60 ? end_samples : samples);
    }
  }
  EXPECT_GT(sum / samples, 0.5);
  EXPECT_LT(sum / samples, 2.0);
  EXPECT_GT(ends / end_samples, 0.5);
  EXPECT_LT(ends / end_samples, 2.0);
  RecordProperty("nees", std::to_string(sum / samples));
  RecordProperty("nees_at_the_end", std::to_string(ends / end_samples));
}

/// NEES a dimension of a few nodes of each robot, over many fleets.
double mean_nees(const SimulatedFleetConfig& config) {
  double sum = 0.0;
  int samples = 0;
  for (unsigned seed = 500; seed < 560; ++seed) {
    const SimulatedFleet fleet(seed, config);
    std::vector<NodeId> some;
    for (const Node& node : fleet.nodes) {
      if (node.id.seq % 20 == 7) some.push_back(node.id);
    }
    const Placement placement = place(fleet, some);
    for (const NodeId& id : some) {
      const Vector6d error = se3_log(placement.T_enu_node.at(id).inverse() * fleet.truth.at(id));
      sum += error.dot(placement.covariance.at(id).llt().solve(error)) / 6.0;
      ++samples;
    }
  }
  return sum / samples;
}

TEST(FleetPlacement, CovariancesPromiseWhatErrorsAreWhereAFilterReckonsWithoutGps) {
  SimulatedFleetConfig config;
  config.filtered = true;
  const std::pair<double, double> all_the_time(0.0, 0.0), three_minutes(30.0, 210.0), the_rest(30.0, 1e9);
  for (const auto& [from, until] : {all_the_time, three_minutes, the_rest}) {
    config.lost_from = from, config.lost_until = until;
    const double nees = mean_nees(config);
    EXPECT_GT(nees, 0.6) << from << " to " << until;
    EXPECT_LT(nees, 1.3) << from << " to " << until;
  }
}

/// What a filter says between two fixes it has from its own heading, which bad GPS leaves false for long.
TEST(FleetPlacement, CovariancesPromiseWhatErrorsAreWhereGpsLeavesHeadingFalse) {
  SimulatedFleetConfig config;
  config.filtered = true;
  config.robots = 1;
  config.lanes = 6;
  for (const double length : {80.0, 160.0}) {
    for (const double sigma : {1.5, 5.0, 10.0}) {
      config.length = length, config.gps_sigma = sigma;
      const double nees = mean_nees(config);
      EXPECT_GT(nees, 0.6) << length << " m, " << sigma << " m";
      EXPECT_LT(nees, 1.3) << length << " m, " << sigma << " m";
    }
  }
}

}  // namespace
}  // namespace fleetmap::graph
