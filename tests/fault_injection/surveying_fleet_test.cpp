#include "surveying_fleet.hpp"

#include <gtest/gtest.h>

#include <set>

#include "store/items.hpp"

namespace fleetmap::fault_injection {
namespace {

using fleetmap::testing::agent;
using std::chrono::seconds;

Scenario scenario() { return {3, 2, seconds(100), {}}; }

/// Two robots in perfect reach of each other.
class Fleet final : public SurveyingFleet {
 public:
  explicit Fleet(const std::filesystem::path& folder) : SurveyingFleet(scenario(), config(), folder) {}

  using SurveyingFleet::kill_robot;
  using SurveyingFleet::member;
  using SurveyingFleet::restart_odometry;
  using SurveyingFleet::robots;
  using SurveyingFleet::start_in_vain;
  void go(Duration time) {
    for (const Stamp end = now() + time; now() < end;) {
      step();
      start_robots(false);
      survey(true);
    }
  }
  std::set<std::uint16_t> sessions_of(const AgentId& name) {
    std::set<std::uint16_t> sessions;
    for (const auto& [id, node] : robot(name).store->nodes())
      if (id.agent == name) sessions.insert(node.session);
    return sessions;
  }
  std::vector<Violation> violations() const {
    Outcome outcome;
    monitor_.fill(outcome);
    return outcome.violations;
  }

 private:
  static const RunConfig& config() {
    static const RunConfig config{.invariants = parse_invariants("all").value()};
    return config;
  }
  void on_sent(const Packet&) override {}
  std::vector<Duration> arrivals(const Packet&, const AgentId&) override { return {seconds(0)}; }
};

TEST(SurveyingFleet, RobotsMapRegisterAndShareWhatTheyMake) {
  const fleetmap::testing::TemporaryFolder folder;
  Fleet fleet(folder / "");
  fleet.go(seconds(80));
  ASSERT_EQ(fleet.robots().size(), 2u);
  const store::Store &first = *fleet.robots().at(agent("r1")).store,
                     &second = *fleet.robots().at(agent("r2")).store;
  EXPECT_GT(first.nodes().size(), 15u);
  EXPECT_GT(second.alignments().size(), 0u);
  EXPECT_EQ(first.node_set().ranges().size(), 2u);
}

TEST(SurveyingFleet, ANewOriginOfTheOdometryBeginsASessionOnceTheDiskWrites) {
  const fleetmap::testing::TemporaryFolder folder;
  Fleet fleet(folder / "");
  fleet.go(seconds(20));
  EXPECT_EQ(fleet.sessions_of(agent("r1")).size(), 1u);
  fleet.member(agent("r1")).disk->set_full(true);
  fleet.restart_odometry(agent("r1"));
  fleet.go(seconds(20));
  fleet.member(agent("r1")).disk->set_full(false);
  fleet.go(seconds(20));
  EXPECT_EQ(fleet.sessions_of(agent("r1")).size(), 2u);
  EXPECT_EQ(fleet.sessions_of(agent("r2")).size(), 1u);
}

TEST(SurveyingFleet, ARobotMayStartHundredsOfTimes) {
  const fleetmap::testing::TemporaryFolder folder;
  Fleet fleet(folder / "");
  fleet.go(seconds(10));
  fleet.kill_robot(agent("r1"));
  fleet.start_in_vain(agent("r1"), 300);
  fleet.member(agent("r1")).start_at = stamp_from_ns(0);
  fleet.go(seconds(10));
  EXPECT_EQ(fleet.robots().size(), 2u);
  EXPECT_EQ(fleet.sessions_of(agent("r1")).size(), 2u);
  EXPECT_TRUE(fleet.violations().empty());
}

}  // namespace
}  // namespace fleetmap::fault_injection
