#include "convergence.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fault_injection/three_robots.hpp"
#include "fleetmap/fleet_codec/messages.hpp"
#include "store/items.hpp"
#include "synthetic_survey.hpp"

namespace fleetmap::fault_injection {
namespace {

using fleetmap::testing::agent;
using fleetmap::testing::TemporaryFolder;
using std::chrono::seconds;
using ::testing::IsEmpty;

/// Robots with stores and exchanges that never met.
class Convergence : public ::testing::Test {
 protected:
  /// `alone`: each is a fleet of its own, and so misses nobody.
  void start(const std::vector<std::string>& names, bool alone = false) {
    exchange::ExchangeConfig config;
    for (const std::string& name : names) config.fleet.push_back(agent(name));
    config.payload_size = [](const exchange::Message& message) {
      return fleet_codec::encode(message).size();
    };
    store::StoreConfig quick;
    quick.power_safe = false;
    for (const std::string& name : names) {
      if (alone) config.fleet = {agent(name)};
      ExchangeFleet::Robot& robot = robots_[agent(name)];
      robot.store = std::make_unique<store::Store>(
          store::Store::open(folder_ / (name + ".db"), agent(name), quick).value());
      robot.cloud_client =
          std::make_unique<loop_closure::CandidateScheduler>(agent(name), loop_closure::CandidateConfig{});
      robot.exchange = std::make_unique<exchange::Exchange>(
          exchange::Exchange::make(config, *robot.store, *robot.cloud_client, kNow).value());
    }
  }
  store::Store& store(const char* name) { return *robots_.at(agent(name)).store; }
  /// The next node of r9, whom none of the robots is.
  SyntheticSurvey::Made next_node() {
    const NodeId id{agent("r9"), first_seq(7) + made_};
    const Duration at = seconds(20 * made_++);
    auto made = survey_.node(0, id, at).value();
    survey_.on_stored(0, id, at);
    return made;
  }
  static void put(store::Store& store, const SyntheticSurvey::Made& made, bool submap = true) {
    EXPECT_EQ(store.put_node(made.node).value(), store::Put::kAdded);
    if (submap) {
      EXPECT_EQ(store.put_submap(made.node.id, made.submap).value(), store::Put::kAdded);
    }
  }
  std::vector<std::string> map_differences_of_robots() const {
    std::vector<std::string> all;
    for (const MapDifference& difference : map_differences(robots_, survey_.site()))
      all.push_back(difference.robot.str() + ": " + difference.what);
    return all;
  }

  TemporaryFolder folder_;
  SyntheticSurvey survey_{5, 1};
  std::uint32_t made_ = 0;
  Robots robots_;
};

TEST_F(Convergence, ARobotAloneHasAlwaysConverged) {
  start({"r1"});
  put(store("r1"), next_node());
  EXPECT_EQ(why_not_converged(robots_, kNow), "");
  EXPECT_EQ(why_incomplete(robots_, kNow), "");
  EXPECT_THAT(map_differences(robots_, survey_.site()), IsEmpty());
}

TEST_F(Convergence, NamesTheFirstItemThatOneRobotHasAndAnotherLacks) {
  start({"r1", "r2"}, true);
  EXPECT_EQ(why_not_converged(robots_, kNow), "");
  const auto first = next_node(), second = next_node();
  put(store("r1"), first);
  EXPECT_EQ(why_not_converged(robots_, kNow), "r2 holds other nodes: r9#7/0 less");
  put(store("r2"), first);
  put(store("r2"), second);
  EXPECT_EQ(why_not_converged(robots_, kNow), "r2 holds other nodes: r9#7/1 more");
  put(store("r1"), second, false);
  EXPECT_EQ(why_not_converged(robots_, kNow), "r2 holds other submaps: r9#7/1 more");
  const auto alignment = fleetmap::testing::make_alignment(first.node.id, second.node.id, agent("r9"), 4);
  ASSERT_EQ(store("r1").put_alignment(alignment).value(), store::Put::kAdded);
  EXPECT_EQ(why_not_converged(robots_, kNow), "r2 holds other alignments: r9/4 less");
}

TEST_F(Convergence, OtherContentsUnderOneNameAreADifference) {
  start({"r1", "r2"}, true);
  auto made = next_node();
  put(store("r1"), made, false);
  made.node.T_odom_base.translation().x() += 1.0;
  put(store("r2"), made, false);
  EXPECT_EQ(why_not_converged(robots_, kNow), "r2 holds another content of a node of r9");
}

TEST_F(Convergence, RobotsThatNeverMetDoNotKnowThatTheyHoldTheSame) {
  start({"r1", "r2"});
  const auto made = next_node();
  for (const char* name : {"r1", "r2"}) put(store(name), made);
  EXPECT_EQ(why_not_converged(robots_, kNow), "r1 finds that another lacks something");
  EXPECT_EQ(why_incomplete(robots_, kNow), "r1 finds that another holds other submaps");
}

TEST_F(Convergence, MapsAreComparedBitForBit) {
  start({"r1", "r2"});
  const auto first = next_node(), second = next_node();
  for (const char* name : {"r1", "r2"}) put(store(name), first);
  EXPECT_THAT(map_differences_of_robots(), IsEmpty());
  put(store("r1"), second, false);
  put(store("r2"), second, true);
  EXPECT_THAT(map_differences_of_robots(), ::testing::ElementsAre("r2: other points"));
  ASSERT_EQ(store("r1").put_submap(second.node.id, second.submap).value(), store::Put::kAdded);
  EXPECT_THAT(map_differences_of_robots(), IsEmpty());
  put(store("r1"), next_node());
  EXPECT_THAT(map_differences_of_robots(), ::testing::ElementsAre("r2: other places", "r2: other points"));
}

}  // namespace
}  // namespace fleetmap::fault_injection
