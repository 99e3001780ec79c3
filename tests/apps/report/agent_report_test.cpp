#include "report/agent_report.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "fleetmap/fault_injection/fleet_run.hpp"
#include "fleetmap/output/global_track.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::apps {
namespace {

using namespace std::chrono_literals;

const AgentId kHonest = AgentId::parse("r1").value();

/// Four robots that map for 80 s.
fault_injection::Scenario fleet_of(std::uint64_t seed, std::vector<fault_injection::Fault> faults) {
  return {seed, 4, 80s, std::move(faults)};
}

/// Robot r3 deceives all the time.
fault_injection::Scenario with_a_compromised_robot(std::uint64_t seed) {
  fault_injection::Fault fault;
  fault.kind = fault_injection::FaultKind::kCompromised;
  fault.begin = 5s;
  fault.length = 75s;
  fault.robots = {2};
  return fleet_of(seed, {fault});
}

struct Reported {
  bool is_garbage = false;  ///< sent by the compromised robot, and nothing that may be believed
  nlohmann::json report;
};

/// The map's part of report.json of honest robot r1 when such a fleet has run.
Reported report_of_honest(const fault_injection::Scenario& scenario) {
  const testing::TemporaryFolder folder;
  fault_injection::RunConfig config;
  config.stores = folder.path();
  config.trace = true;
  const fault_injection::Outcome outcome = fault_injection::run(scenario, config);
  auto store = store::Store::open(folder.path() / "r1.db", kHonest, {}).value();
  (void)output::GlobalTrackFile::append_to(folder.path() / "global_track.csv").value();
  const output::Results results = output::write_results(store, {kHonest, folder.path(), {}}).value();
  Reported reported;
  reported.is_garbage = std::ranges::any_of(outcome.trace, [](const std::string& line) {
    return line.find("deceives by scheme garbage") != std::string::npos;
  });
  add_holdings(reported.report, store, &results);
  return reported;
}

TEST(AgentReport, NamesTheRobotThatSendsGarbageAndNoOther) {
  int garbage = 0;
  for (std::uint64_t seed = 1; garbage < 2; ++seed) {
    ASSERT_LT(seed, 60u) << "a quarter of the seeds should send garbage";
    const auto [is_garbage, report] = report_of_honest(with_a_compromised_robot(seed));
    const nlohmann::json named = report.value("contradict_the_fleet", nlohmann::json::object());
    for (const auto& [robot, evidence] : named.items()) EXPECT_EQ(robot, "r3") << evidence;
    if (!is_garbage) continue;
    ++garbage;
    ASSERT_TRUE(named.contains("r3")) << "seed " << seed;
    const nlohmann::json& evidence = named["r3"];
    EXPECT_GT(evidence["contradicting_steps"].get<int>() + evidence["impossible_items"].get<int>(), 0);
  }
}

TEST(AgentReport, NamesNobodyInAnHonestFleet) {
  const nlohmann::json report = report_of_honest(fleet_of(1, {})).report;
  EXPECT_FALSE(report.contains("contradict_the_fleet")) << report["contradict_the_fleet"];
  EXPECT_GT(report["nodes"].get<int>(), 20);
  EXPECT_GT(report["own_nodes"].get<int>(), 0);
  EXPECT_LT(report["own_nodes"].get<int>(), report["nodes"].get<int>());
}

TEST(AgentReport, HasNoOriginWhereNoNodeHasAPlaceOnEarth) {
  const testing::TemporaryFolder folder;
  const auto store = store::Store::open(folder.path() / "r1.db", kHonest, {}).value();
  output::Results results;
  nlohmann::json report;
  add_holdings(report, store, &results);
  EXPECT_FALSE(report.contains("origin")) << report["origin"];
  results.origin = geo_point_from_degrees(49.0, 8.4, 110.0);
  add_holdings(report, store, &results);
  EXPECT_NEAR(report["origin"]["latitude_deg"].get<double>(), 49.0, 1e-9);
}

}  // namespace
}  // namespace fleetmap::apps
