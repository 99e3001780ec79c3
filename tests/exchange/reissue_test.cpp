#include "fleetmap/exchange/reissue.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "exchange/sim_fleet.hpp"

namespace fleetmap::exchange {
namespace {

using testing::agent;
using testing::make_node;
using testing::SimFleet;

class ReissueTest : public ::testing::Test {
 protected:
  ReissueTest() {
    fleet_.reachable = [](const AgentId&, const AgentId&, Reach) { return true; };
    for (const char* name : {"r1", "r2", "r3"}) fleet_.start(name, 7);
    for (int k = 0; k < 5; ++k) made_.push_back(fleet_.add_node("r2", 10.0 * k));
    fleet_.run_for(std::chrono::minutes(1), [&] { return fleet_.equal_sets(5); });
  }
  /// All robots hold the content and its submap under some name.
  bool all_hold(const graph::Node& node) const {
    return fleet_.all([&](const SimFleet::Robot& robot) {
      return std::ranges::any_of(robot.store->nodes(), [&](const auto& entry) {
        return is_same_place(entry.second, node) && robot.store->has_submap(entry.first);
      });
    });
  }
  void forge_to_all(const graph::Node& node) {
    for (const char* name : {"r1", "r2", "r3"}) fleet_.forge(name, node);
    fleet_.run_for(std::chrono::seconds(20));
  }
  graph::Node another(const NodeId& id) const {
    graph::Node node = make_node(id.agent, id.seq, testing::random_bytes(500, 99), 77.0, 99);
    node.session = session_of(id.seq);
    return node;
  }

  SimFleet fleet_{{"r1", "r2", "r3"}, {}, 3, {}, testing::no_candidates};
  std::vector<graph::Node> made_;
};

TEST_F(ReissueTest, AContestedNodeKeepsItsContentUnderAnotherName) {
  forge_to_all(another(made_[2].id));
  fleet_.run_for(std::chrono::minutes(2), [&] { return all_hold(made_[2]); });
  EXPECT_TRUE(all_hold(made_[2]));
  EXPECT_FALSE(fleet_.robot("r1").store->node(made_[2].id));
}

/// A damaged packet can bring a node under another name of its maker, where nobody holds its submap.
TEST_F(ReissueTest, ACopyWithoutTheSubmapDoesNotTakeThePlaceOfTheNode) {
  for (const bool copy_is_contested : {false, true}) {
    graph::Node copy = made_[copy_is_contested ? 2 : 3];
    const graph::Node genuine = copy;
    copy.id.seq = first_seq(5) + (copy_is_contested ? 2 : 3);
    copy.session = session_of(copy.id.seq);
    copy.signature.reset();
    forge_to_all(copy);
    if (copy_is_contested) forge_to_all(another(copy.id));
    forge_to_all(another(genuine.id));
    fleet_.run_for(std::chrono::minutes(2), [&] { return all_hold(genuine); });
    EXPECT_TRUE(all_hold(genuine)) << copy_is_contested;
  }
}

}  // namespace
}  // namespace fleetmap::exchange
