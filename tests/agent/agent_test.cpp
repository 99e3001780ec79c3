#include "fleetmap/agent/agent.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "agent/lapping_robot.hpp"
#include "bus/captured_log.hpp"
#include "fleetmap/core/paths.hpp"
#include "support/robots.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::agent {
namespace {

using fleetmap::testing::kPeer;
using fleetmap::testing::kSelf;
using namespace std::chrono_literals;
using fleetmap::testing::LappingRobot;
using fleetmap::testing::TemporaryFolder;
using ::testing::HasSubstr;

class AgentTest : public ::testing::Test {
 protected:
  LappingRobot::Options options() const {
    LappingRobot::Options options;
    options.scan_rate = 5.0;
    options.columns = 400;
    options.folder = folder_.path() / "r1";
    return options;
  }
  AgentConfig config(const char* name) const {
    AgentConfig config;
    config.id = AgentId::parse(name).value();
    config.directory = folder_.path() / name;
    config.exchange.fleet = {kSelf, kPeer};
    config.store.power_safe = false;
    return config;
  }

  TemporaryFolder folder_;
  bus::testing::CapturedLog log_;
};

TEST_F(AgentTest, ADirectoryThatCannotBeMadeIsNamedWithARemedy) {
  std::ofstream(folder_.path() / "r1") << "a file";
  const auto network = bus::LocalNetwork::create({}).value();
  const auto agent = Agent::create(config("r1"), network->add_robot(kSelf));
  ASSERT_FALSE(agent);
  EXPECT_THAT(agent.error().message,
              ::testing::AllOf(HasSubstr((folder_.path() / "r1").string()), HasSubstr("`directory`")));
}

/// Scans become odometry, odometry nodes, and each node has its submap; the rest becomes one at the end.
TEST_F(AgentTest, MakesNodesOnItsWayAndOneOfTheRest) {
  LappingRobot robot(options());
  robot.run_for(20.0);
  Agent& agent = robot.agent();
  const double spacing = agent.config().nodes.spacing;
  const auto& nodes = agent.store().nodes();
  ASSERT_GE(nodes.size(), 3u) << log_.text();
  const graph::Node* before = nullptr;
  for (const auto& [name, node] : nodes) {
    EXPECT_TRUE(agent.store().has_submap(name));
    if (before != nullptr) {
      const double way = (node.T_odom_base.translation() - before->T_odom_base.translation()).norm();
      EXPECT_LT(way, spacing + 0.7) << "0.6 m are driven between scans at most";
      EXPECT_GT(way, 0.5 * spacing) << "a figure eight bends";
      EXPECT_GT(node.stamp, before->stamp);
    }
    before = &node;
  }
  const std::size_t driven = nodes.size();
  agent.freeze_rest();
  EXPECT_EQ(nodes.size(), driven + 1);
  agent.freeze_rest();
  EXPECT_EQ(nodes.size(), driven + 1) << "nothing is left";
  EXPECT_EQ(agent.scan_seconds().count(), agent.perception().odometry_counters().updates);
  EXPECT_GT(agent.work_seconds().odometry, 0.0);
}

/// The motion between two starts is unknown, so the second one is a session, and a frame, of its own.
TEST_F(AgentTest, AStartGoesOnInASessionOfItsOwn) {
  std::set<NodeId> first;
  {
    LappingRobot robot(options());
    robot.run_for(12.0);
    for (const auto& [name, node] : robot.agent().store().nodes()) first.insert(name);
  }
  ASSERT_FALSE(first.empty());
  LappingRobot again(options());
  EXPECT_EQ(log_.count("going on from " + std::to_string(first.size()) + " nodes"), 1) << log_.text();
  again.run_for(12.0);
  std::set<std::uint16_t> sessions;
  std::size_t kept = 0;
  for (const auto& [name, node] : again.agent().store().nodes()) {
    sessions.insert(node.session);
    kept += first.contains(name);
  }
  EXPECT_EQ(kept, first.size());
  EXPECT_EQ(sessions.size(), 2u);
  EXPECT_TRUE(is_there(folder_.path() / "r1" / "store.db"));
}

/// An order on one robot is in force on the other one, too, and survives neither being asked again.
TEST_F(AgentTest, AnOrderGivenHereIsObeyedThere) {
  const auto network = bus::LocalNetwork::create({}).value();
  std::vector<std::unique_ptr<Agent>> agents;
  for (const char* name : {"r1", "r2"}) {
    bus::Bus& bus = network->add_robot(AgentId::parse(name).value());
    network->set_position(AgentId::parse(name).value(), {0.0, 0.0, 0.0});
    agents.push_back(Agent::create(config(name), bus).value());
  }
  network->run_until(Stamp{} + 5s);
  EXPECT_FALSE(agents[1]->exchange().hold_in_force());
  agents[0]->give_order(messages::HoldOrder{
      .stamp = {}, .robot = {}, .issuer = kSelf, .kind = messages::HoldOrder::Kind::kHold});
  network->run_until(Stamp{} + 10s);
  ASSERT_TRUE(agents[1]->exchange().hold_in_force());
  EXPECT_EQ(agents[1]->exchange().hold_in_force()->kind, messages::HoldOrder::Kind::kHold);
  EXPECT_TRUE(agents[0]->idle());
}

}  // namespace
}  // namespace fleetmap::agent
