#include "fleetmap/graph/contradictions.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "graph/torn_fleet.hpp"

namespace fleetmap::graph {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::joint_error;
using testing::kR1;
using testing::kR2;
using testing::kR3;
using testing::kR4;
using testing::place;
using testing::SimulatedFleet;
using testing::torn_fleet;

AlignmentOutcome outcome(const AgentId& a, const AgentId& b, AlignmentStatus status) {
  AlignmentOutcome one;
  one.i.agent = a;
  one.j.agent = b;
  one.computed_by = a;
  one.status = status;
  return one;
}

/// So many rejected and used alignments of two robots.
void add(Placement& placement, const AgentId& a, const AgentId& b, int rejected, int used) {
  for (int k = 0; k < rejected; ++k)
    placement.outcomes.push_back(outcome(a, b, AlignmentStatus::against_others));
  for (int k = 0; k < used; ++k) placement.outcomes.push_back(outcome(b, a, AlignmentStatus::used));
}

TEST(Contradictions, NameTheRobotThatTwoOthersContradictAndNoneOfThese) {
  Placement placement;
  add(placement, kR1, kR4, 5, 0);
  add(placement, kR2, kR4, 4, 1);
  add(placement, kR1, kR2, 2, 9);
  const auto named = contradict_the_fleet(placement, {}, LocalFrame(GeoPoint{}));
  ASSERT_EQ(named.size(), 1u);
  EXPECT_EQ(named.at(kR4).alignments, 9u);
  EXPECT_THAT(named.at(kR4).with, ElementsAre(kR1, kR2));
}

TEST(Contradictions, TwoRobotsThatContradictOnlyEachOtherAreNotNamed) {
  Placement placement;
  add(placement, kR1, kR4, 9, 0);
  add(placement, kR2, kR3, 0, 9);
  EXPECT_THAT(contradict_the_fleet(placement, {}, LocalFrame(GeoPoint{})), IsEmpty());
}

TEST(Contradictions, NameARobotWhoseFixesAndOdometryContradictEachOther) {
  SimulatedFleet fleet(1);
  EXPECT_THAT(contradict_the_fleet(place(fleet), fleet.nodes, fleet.site), IsEmpty());
  for (Node& node : fleet.nodes) {
    if (node.id.agent == kR2 && node.id.seq % 2 == 0)
      node.G->position = fleet.site.to_geo(fleet.truth.at(node.id) * Eigen::Vector3d(40.0, 0.0, 0.0));
  }
  const auto named = contradict_the_fleet(place(fleet), fleet.nodes, fleet.site);
  ASSERT_EQ(named.size(), 1u);
  EXPECT_GT(named.at(kR2).steps, 20u);
}

TEST(Contradictions, NameARobotWhoseNodesHaveImpossibleNumbers) {
  SimulatedFleet fleet(1);
  fleet.nodes.front().T_odom_base.translation().x() = 1e7;
  const auto named = contradict_the_fleet(place(fleet), fleet.nodes, fleet.site);
  ASSERT_EQ(named.size(), 1u);
  EXPECT_EQ(named.at(kR1).impossible, 1u);
}

/// The alignments of the compromised robot are sure of themselves and as many as those of the others.
TEST(Contradictions, ARobotThatTearsTheOthersApartIsNamedAndLeftOut) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    SimulatedFleet fleet = torn_fleet(seed, 6.0);
    const Placement placement = place(fleet);
    EXPECT_EQ(placement.contradicting, kR4);
    const auto named = contradict_the_fleet(placement, fleet.nodes, fleet.site);
    ASSERT_EQ(named.size(), 1u);
    EXPECT_THAT(named.at(kR4).with, ElementsAre(kR1, kR2, kR3));
    const double error = joint_error(fleet, placement, {kR1, kR2, kR3});
    std::erase_if(fleet.alignments, [](const Alignment& a) { return a.i.agent == kR4 || a.j.agent == kR4; });
    EXPECT_NEAR(error, joint_error(fleet, place(fleet), {kR1, kR2, kR3}), 0.01) << "seed " << seed;
  }
}

}  // namespace
}  // namespace fleetmap::graph
