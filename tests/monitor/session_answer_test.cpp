#include "monitor/session_answer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "monitor/views.hpp"
#include "store/items.hpp"

namespace fleetmap::monitor {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::node_id;
using testing::ViewMaker;

/// A second session of r2, an hour later, whose nodes are 4 m apart from 200 m on.
void add_session(FleetView& view, std::uint32_t count) {
  const graph::Node first = view.nodes.back();
  for (std::uint32_t k = 0; k < count; ++k) {
    graph::Node node = first;
    node.id = {testing::agent("r2"), first_seq(1) + k};
    node.session = 1;
    node.stamp += std::chrono::hours(1);
    view.nodes.push_back(node);
    view.has_submap.push_back(true);
    view.placement.T_enu_node[node.id] = Pose(Eigen::Translation3d(200.0 + 4.0 * k, 0.0, 0.0));
  }
  view.placement.components.push_back({view.nodes.back().frame()});
}

TEST(SessionAnswer, ASessionThatNothingJoinsIsNamedThoughTheRobotsAreJoined) {
  ViewMaker fleet;
  fleet.robot("r1", 0).robot("r2", 5);
  fleet.alignment(node_id("r1", 0), node_id("r2", 0), graph::AlignmentStatus::used);
  EXPECT_THAT(loose_sessions(fleet.view), IsEmpty());
  add_session(fleet.view, 20);
  EXPECT_THAT(loose_sessions(fleet.view), ElementsAre("r2's second session is not joined"));
}

TEST(SessionAnswer, ASessionOfTheMainComponentIsNotNamed) {
  ViewMaker fleet;
  fleet.robot("r1", 0).robot("r2", 5);
  fleet.alignment(node_id("r1", 0), node_id("r2", 0), graph::AlignmentStatus::used);
  add_session(fleet.view, 2);
  auto& components = fleet.view.placement.components;
  components.front().push_back(components.back().front());
  components.pop_back();
  EXPECT_THAT(loose_sessions(fleet.view), IsEmpty());
}

TEST(SessionAnswer, OfRobotsThatNothingJoinsThePairsTell) {
  ViewMaker fleet;
  fleet.robot("r1", 0).robot("r2", 500);
  EXPECT_THAT(loose_sessions(fleet.view), IsEmpty());
}

TEST(SessionAnswer, OfOneRobotTheSessionWithFewerNodesIsLoose) {
  ViewMaker fleet;
  fleet.robot("r2", 0, 3);
  add_session(fleet.view, 20);
  EXPECT_THAT(loose_sessions(fleet.view), ElementsAre("r2's first session is not joined"));
}

}  // namespace
}  // namespace fleetmap::monitor
