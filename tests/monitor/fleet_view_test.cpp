#include "fleetmap/monitor/fleet_view.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "monitor/views.hpp"
#include "store/items.hpp"

namespace fleetmap::monitor {
namespace {

using graph::AlignmentStatus;
using testing::agent;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::make_alignment;
using testing::node_id;
using testing::ViewMaker;
using Indices = std::vector<std::optional<std::size_t>>;

std::vector<std::string> names(const FleetView& view) {
  std::vector<std::string> all;
  for (const AgentId& robot : robots_of(view)) all.push_back(robot.str());
  return all;
}

TEST(FleetView, names_every_robot_of_which_anything_is_known_once) {
  EXPECT_THAT(names({}), IsEmpty()) << "an operator's store has no robot of its own";
  ViewMaker fleet;
  fleet.view.self = agent("a");
  fleet.robot("c", 0).robot("b", 5);
  fleet.view.alignments.push_back(make_alignment(node_id("c", 0), node_id("b", 0), agent("d"), 0));
  fleet.attempt(node_id("e", 0), node_id("f", 0), "rejected");
  fleet.view.attempts.back().by = agent("g");
  fleet.view.holdings.push_back({agent("h"), agent("i"), 0, 0, 0});
  EXPECT_THAT(names(fleet.view), ElementsAre("a", "b", "c", "d", "e", "f", "g", "h", "i"));
  fleet.view.fleet = {agent("a"), agent("z")};
  EXPECT_THAT(names(fleet.view), ElementsAre("a", "b", "c", "d", "e", "f", "g", "h", "i", "z"))
      << "z is configured, but never came";
}

TEST(FleetView, an_outcome_of_the_graph_prevails_over_the_list_of_used_alignments) {
  ViewMaker fleet;
  const graph::Alignment first = make_alignment(node_id("r1", 0), node_id("r2", 0), agent("r1"), 3);
  const graph::Alignment second = make_alignment(node_id("r1", 0), node_id("r2", 0), agent("r2"), 3);
  fleet.view.placement.used = {first, second};
  fleet.view.placement.outcomes = {
      {first.i, first.j, agent("r1"), 3, AlignmentStatus::against_gps, 0},
      {first.i, first.j, agent("r1"), 4, AlignmentStatus::waiting, 0},
  };
  const Outcomes expected{{{agent("r1"), 3}, AlignmentStatus::against_gps},
                          {{agent("r1"), 4}, AlignmentStatus::waiting},
                          {{agent("r2"), 3}, AlignmentStatus::used}};
  EXPECT_EQ(outcomes_of(fleet.view), expected);
}

TEST(FleetView, an_attempt_has_the_alignment_of_its_pair_in_its_direction_by_its_robot) {
  ViewMaker fleet;
  const NodeId a = node_id("r1", 0), b = node_id("r2", 1);
  fleet.view.alignments = {make_alignment(b, a, agent("r1"), 0), make_alignment(a, b, agent("r2"), 0),
                           make_alignment(a, b, agent("r1"), 1)};
  fleet.attempt(a, b, "accepted");  // by r1
  EXPECT_EQ(alignments_of_attempts(fleet.view), Indices{2});
  fleet.view.attempts[0].by = agent("r2");
  EXPECT_EQ(alignments_of_attempts(fleet.view), Indices{1});
  fleet.view.attempts[0].by = agent("r3");
  EXPECT_EQ(alignments_of_attempts(fleet.view), Indices{std::nullopt});
}

TEST(FleetView, attempts_at_one_pair_have_their_alignments_in_order_as_far_as_they_go) {
  ViewMaker fleet;
  const NodeId a = node_id("r1", 0), b = node_id("r2", 1);
  fleet.view.alignments = {make_alignment(a, b, agent("r1"), 0), make_alignment(a, b, agent("r1"), 1)};
  for (const char* verdict : {"failed", "ambiguous", "rejected", "accepted", "accepted"})
    fleet.attempt(a, b, verdict);
  EXPECT_EQ(alignments_of_attempts(fleet.view), (Indices{std::nullopt, 0, std::nullopt, 1, std::nullopt}));
}

}  // namespace
}  // namespace fleetmap::monitor
