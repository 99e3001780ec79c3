#include "problem/valid_items.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "graph/simulated_fleet.hpp"

namespace fleetmap::graph {
namespace {

using testing::SimulatedFleet;

TEST(ValidItems, AreSortedByNameInWhateverOrderTheyCome) {
  SimulatedFleet fleet(1);
  std::ranges::shuffle(fleet.nodes, fleet.random());
  std::ranges::shuffle(fleet.alignments, fleet.random());
  const SortedItems items = sorted_items(fleet.nodes, fleet.alignments, fleet.site);
  ASSERT_EQ(items.nodes.size(), fleet.nodes.size());
  ASSERT_EQ(items.alignments.size(), fleet.alignments.size());
  EXPECT_TRUE(std::ranges::is_sorted(items.nodes, {}, [](const Node* node) { return node->id; }));
  EXPECT_TRUE(std::ranges::is_sorted(items.alignments, {},
                                     [](const Alignment* a) { return std::pair(a->computed_by, a->seq); }));
}

TEST(ValidItems, NodesWithImpossibleNumbersAreLeftOut) {
  SimulatedFleet fleet(2);
  const std::size_t all = fleet.nodes.size();
  fleet.nodes[3].G.reset();
  fleet.nodes[5].T_odom_base.translation().x() = 1e12;
  fleet.nodes[7].odom_covariance(0, 0) = std::nan("");
  fleet.nodes[9].G->q_enu_base.coeffs() *= 2.0;
  fleet.nodes[11].G->position.latitude += 0.5;  // 3,000 km
  EXPECT_EQ(sorted_items(fleet.nodes, {}, fleet.site).nodes.size(), all - 5);
}

TEST(ValidItems, AlignmentsAreInvalidOrWaitForTheirNodes) {
  SimulatedFleet fleet(3);
  Alignment a = fleet.alignments.front();
  const auto items = sorted_items(fleet.nodes, fleet.alignments, fleet.site);
  EXPECT_EQ(initial_status(a, items.nodes), AlignmentStatus::undecided);
  a.j.seq += 10'000;
  EXPECT_EQ(initial_status(a, items.nodes), AlignmentStatus::waiting);
  a.j = a.i;
  EXPECT_EQ(initial_status(a, items.nodes), AlignmentStatus::invalid);
  a = fleet.alignments.front();
  a.modes.front().covariance(2, 2) = -1.0;
  EXPECT_EQ(initial_status(a, items.nodes), AlignmentStatus::invalid);
}

}  // namespace
}  // namespace fleetmap::graph
