#include "fleetmap/monitor/pair_answer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "monitor/views.hpp"
#include "store/items.hpp"

namespace fleetmap::monitor {
namespace {

using graph::AlignmentStatus;
using testing::agent;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::node_id;
using ::testing::Not;
using ::testing::StartsWith;
using testing::ViewMaker;

PairAnswer answer_of(const FleetView& view, const std::string& a, const std::string& b) {
  for (const PairAnswer& answer : explain_pairs(view)) {
    if (answer.a == agent(a) && answer.b == agent(b)) return answer;
  }
  ADD_FAILURE() << "no answer for " << a << " and " << b;
  return {};
}

TEST(PairAnswer, robots_with_an_alignment_in_use_are_joined) {
  ViewMaker fleet;
  fleet.robot("r1", 0).robot("r2", 5);
  fleet.alignment(node_id("r1", 0), node_id("r2", 0), AlignmentStatus::used);
  fleet.alignment(node_id("r2", 1), node_id("r1", 1), AlignmentStatus::against_gps);
  const PairAnswer answer = answer_of(fleet.view, "r1", "r2");
  EXPECT_EQ(answer.state, PairState::joined);
  EXPECT_EQ(answer.used, 1u);
  EXPECT_EQ(answer.text, "1 alignment in use joins r1 and r2.");
}

TEST(PairAnswer, robots_far_apart_were_never_near) {
  ViewMaker fleet;
  fleet.robot("r1", 0).robot("r3", 100);
  const PairAnswer answer = answer_of(fleet.view, "r1", "r3");
  EXPECT_EQ(answer.state, PairState::never_near);
  ASSERT_TRUE(answer.nearest_m);
  EXPECT_DOUBLE_EQ(*answer.nearest_m, 92.0);
  EXPECT_EQ(*answer.nearest, std::pair(node_id("r1", 2), node_id("r3", 0)));
  EXPECT_THAT(answer.text,
              AllOf(HasSubstr("never near"), HasSubstr("92 m (r1/2 and r3/0)"), HasSubstr("within 30 m")));
}

TEST(PairAnswer, the_radius_decides_what_is_near) {
  ViewMaker fleet;
  fleet.robot("r1", 0, 1).robot("r2", 20, 1).logs({"r1", "r2"});
  fleet.view.search_radius_m = 20.0;
  EXPECT_EQ(explain_pairs(fleet.view).front().state, PairState::not_tried);
  fleet.view.search_radius_m = 19.9;
  EXPECT_EQ(explain_pairs(fleet.view).front().state, PairState::never_near);
}

TEST(PairAnswer, heights_do_not_count_in_what_is_near) {
  ViewMaker fleet;
  fleet.robot("r1", 0, 1).robot("r2", 20, 1).logs({"r1", "r2"});
  fleet.view.placement.T_enu_node.at(node_id("r2", 0)).translation().z() = 60.0;
  const PairAnswer answer = answer_of(fleet.view, "r1", "r2");
  EXPECT_EQ(answer.state, PairState::not_tried) << "GPS may err by as much in height";
  EXPECT_DOUBLE_EQ(*answer.nearest_m, 20.0);
}

TEST(PairAnswer, near_robots_that_nobody_registered) {
  ViewMaker fleet;
  fleet.robot("r1", 0).robot("r2", 12).logs({"r1", "r2"});
  const PairAnswer answer = answer_of(fleet.view, "r1", "r2");
  EXPECT_EQ(answer.state, PairState::not_tried);
  EXPECT_THAT(answer.missing_logs, IsEmpty());
  EXPECT_THAT(answer.text, AllOf(HasSubstr("neither registered the other's nodes"),
                                 HasSubstr("within 4.0 m (r1/2 and r2/0)")));
}

TEST(PairAnswer, registrations_of_robots_whose_log_is_elsewhere_are_not_known) {
  ViewMaker fleet;
  fleet.robot("r1", 0).robot("r2", 100).robot("r3", 12);
  EXPECT_THAT(answer_of(fleet.view, "r1", "r3").text, HasSubstr("since no log of registrations is here"));
  fleet.logs({"r2"});
  const PairAnswer none = answer_of(fleet.view, "r1", "r3");
  EXPECT_EQ(none.state, PairState::not_known);
  EXPECT_THAT(none.missing_logs, ElementsAre(agent("r1"), agent("r3")));
  EXPECT_EQ(
      none.text,
      "r1 and r3 were near: their nodes came within 4.0 m (r1/2 and r3/0); whether r1 or r3 registered "
      "them is not known here, since only r2's log of registrations is here: open the page of r1 or r3.");
  fleet.logs({"r1"});
  const PairAnswer half = answer_of(fleet.view, "r1", "r3");
  EXPECT_EQ(half.state, PairState::not_known);
  EXPECT_THAT(half.text, AllOf(HasSubstr("whether r3 registered them is not known here"),
                               HasSubstr("only r1 and r2's log"), HasSubstr("open the page of r3")));
}

TEST(PairAnswer, a_log_that_is_elsewhere_may_hold_more_rejections) {
  ViewMaker fleet;
  fleet.robot("r1", 0).robot("r2", 12).logs({"r1"});
  fleet.attempt(node_id("r1", 0), node_id("r2", 0), "rejected", "x");
  const PairAnswer answer = answer_of(fleet.view, "r1", "r2");
  EXPECT_EQ(answer.state, PairState::rejected);
  EXPECT_THAT(answer.text, HasSubstr("r2 may have tried more: its registrations.csv is not here"));
  fleet.logs({"r2"});
  EXPECT_THAT(answer_of(fleet.view, "r1", "r2").text, Not(HasSubstr("tried more")));
}

TEST(PairAnswer, rejections_are_counted_by_what_was_wrong) {
  ViewMaker fleet;
  fleet.robot("r1", 0).robot("r2", 12).logs({"r1", "r2"});
  fleet.attempt(node_id("r1", 0), node_id("r2", 0), "rejected",
                "inlier RMSE is 0.31 m, at most 0.20 m is good");
  fleet.attempt(node_id("r1", 1), node_id("r2", 0), "rejected", "only 12 inliers, at least 200 are needed");
  fleet.attempt(node_id("r2", 1), node_id("r1", 2), "rejected", "only 99 inliers, at least 200 are needed");
  const PairAnswer answer = answer_of(fleet.view, "r1", "r2");
  EXPECT_EQ(answer.state, PairState::rejected);
  EXPECT_EQ(answer.attempts, 3u);
  EXPECT_EQ(
      answer.text,
      "r1 and r2 were registered 3 times, and none was accepted: 2 times because only 12 to 99 inliers, "
      "at least 200 are needed; once because inlier RMSE is 0.31 m, at most 0.20 m is good.");
}

TEST(PairAnswer, too_little_overlap_is_an_answer_of_its_own) {
  ViewMaker fleet;
  fleet.robot("r1", 0).robot("r2", 12);
  fleet.attempt(
      node_id("r1", 0), node_id("r2", 0), "rejected",
      "only 0.10 of the source points are inliers, at least 0.20 are needed: the clouds overlap too little");
  const PairAnswer answer = answer_of(fleet.view, "r1", "r2");
  EXPECT_EQ(answer.state, PairState::no_overlap);
  EXPECT_THAT(answer.text, HasSubstr("without enough overlap"));
}

TEST(PairAnswer, alignments_that_the_graph_refuses_are_named_with_its_reason) {
  ViewMaker fleet;
  fleet.robot("r1", 0).robot("r2", 12);
  fleet.attempt(node_id("r1", 0), node_id("r2", 0), "accepted");
  fleet.alignment(node_id("r1", 0), node_id("r2", 0), AlignmentStatus::against_gps);
  fleet.alignment(node_id("r1", 1), node_id("r2", 1), AlignmentStatus::undecided);
  const PairAnswer answer = answer_of(fleet.view, "r1", "r2");
  EXPECT_EQ(answer.state, PairState::alignments_unused);
  EXPECT_EQ(answer.accepted, 1u);
  EXPECT_THAT(answer.text,
              AllOf(HasSubstr("2 alignments"), HasSubstr("1: the graph does not use it: it contradicts GPS"),
                    HasSubstr("too little evidence")));
}

TEST(PairAnswer, a_third_robot_joins_two) {
  ViewMaker fleet;
  fleet.robot("r1", 0).robot("r2", 50).robot("r3", 100);
  fleet.alignment(node_id("r1", 2), node_id("r2", 0), AlignmentStatus::used);
  fleet.alignment(node_id("r2", 2), node_id("r3", 0), AlignmentStatus::used);
  const PairAnswer answer = answer_of(fleet.view, "r1", "r3");
  EXPECT_EQ(answer.state, PairState::joined_by_others);
  EXPECT_TRUE(is_joined(answer.state));
  EXPECT_THAT(answer.text, AllOf(HasSubstr("Joined through r2"), HasSubstr("never near")));
}

TEST(PairAnswer, without_GPS_and_alignments_nobody_knows_whether_they_met) {
  ViewMaker fleet;
  fleet.robot("r1", 0).robot("r2", 1, 3, false);
  const PairAnswer answer = answer_of(fleet.view, "r1", "r2");
  EXPECT_EQ(answer.state, PairState::not_tied);
  EXPECT_EQ(answer.nearest_m, std::nullopt) << "its place is a guess, and so is the distance";
  EXPECT_THAT(answer.text, StartsWith("r2 has no place on Earth"));
}

TEST(PairAnswer, a_robot_of_which_nothing_is_held) {
  ViewMaker fleet;
  fleet.robot("r1", 0);
  fleet.view.holdings.push_back({agent("r4"), agent("r4"), 0, 0, 0});
  const PairAnswer answer = answer_of(fleet.view, "r1", "r4");
  EXPECT_EQ(answer.state, PairState::nothing_known);
  EXPECT_THAT(answer.text, HasSubstr("No node of r4"));
}

TEST(PairAnswer, every_pair_has_one_answer_in_order) {
  ViewMaker fleet;
  fleet.robot("r3", 0).robot("r1", 40).robot("r2", 80);
  const auto answers = explain_pairs(fleet.view);
  ASSERT_EQ(answers.size(), 3u);
  EXPECT_EQ(answers[0].b, agent("r2"));
  EXPECT_EQ(answers[1].b, agent("r3"));
  EXPECT_EQ(answers[2].a, agent("r2"));
}

}  // namespace
}  // namespace fleetmap::monitor
