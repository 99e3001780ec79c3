#include "report/report_warnings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace fleetmap::apps {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// Two robots of which nothing is wrong.
json sound_fleet() {
  const json robot = {{"nodes", 8},
                      {"own_nodes", 4},
                      {"map_hash", "a1"},
                      {"not_georeferenced", json::array()},
                      {"missing_submaps", 0},
                      {"store_failures", 0},
                      {"bus_drops", json::object()},
                      {"sensors",
                       {{"fixes", 30},
                        {"scans", 90},
                        {"odometry_updates", 90},
                        {"lost_scans", 0},
                        {"dropped_scans", 0},
                        {"findings", json::array()}}},
                      {"localization", {{"fix_used", 30}}},
                      {"exchange", {{"misbehaved", json::object()}}}};
  return {{"exchange_ended", true}, {"agents", {{"r1", robot}, {"r2", robot}}}};
}

monitor::PairAnswer apart() {
  monitor::PairAnswer pair;
  pair.a = AgentId::parse("r1").value();
  pair.b = AgentId::parse("r2").value();
  pair.state = monitor::PairState::never_near;
  pair.text = "They were never near each other.";
  return pair;
}

TEST(ReportWarnings, SoundRunHasNoWarnings) {
  EXPECT_THAT(report_warnings(sound_fleet(), {}), IsEmpty());
  monitor::PairAnswer joined = apart();
  joined.state = monitor::PairState::joined;
  EXPECT_THAT(report_warnings(sound_fleet(), {joined}), IsEmpty());
  EXPECT_THAT(report_warnings(json::object(), {}), IsEmpty());
}

TEST(ReportWarnings, RobotsWithoutAMapStandBeforePairsAndSensors) {
  json report = sound_fleet();
  report["agents"]["r2"]["problem"] = "its store is damaged";
  report["agents"]["r1"]["sensors"]["findings"] = {"IMU in g, converted: set the driver to m/s^2"};
  EXPECT_THAT(
      report_warnings(report, {apart()}),
      ElementsAre("r2: its store is damaged", "r1 and r2 are not joined. They were never near each other.",
                  "r1: IMU in g, converted: set the driver to m/s^2"));
}

TEST(ReportWarnings, EachCounterThatShouldBeZeroIsNamedWithItsRobot) {
  for (const auto& [pointer, value, words] :
       {std::tuple{"/agents/r2/missing_submaps", json(3), "r2: 3 submaps are missing"},
        {"/agents/r2/store_failures", json(2), "r2: 2 items could not be stored"},
        {"/agents/r2/bus_drops", json{{"fleetmap/node", 5}}, "r2: 5 messages of fleetmap/node were dropped"},
        {"/agents/r2/problem", json("r2: there is no map"), "r2: there is no map"},
        {"/agents/r2/recording", json{{"findings", {"1 part is damaged"}}}, "r2: 1 part is damaged"},
        {"/agents/r2/sensors/lost_scans", json(7), "r2: the odometry lost its way: 7 of 90 scans"},
        {"/agents/r2/sensors/dropped_scans", json(8), "r2: 8 scans were dropped"},
        {"/agents/r2/exchange/misbehaved", json{{"r9", 4}}, "r2 refused 4 messages of r9"},
        {"/agents/r2/switched_off", json(true), "r2 was switched off"},
        {"/agents/r2/map_hash", json("b2"), "the robots hold different maps"},
        {"/agents/r2/alignments_computed_by", json{{"r3", {{"quarantined", true}}}}, "r3 is in quarantine"},
        {"/agents/r2/contradict_the_fleet", json{{"r3", {{"left_out", true}}}},
         "r3 contradicts the fleet and is left"},
        {"/exchange_ended", json(false), "the exchange did not come to its end"},
        {"/completion/why_not", json("time is up"), "the mission was not completed: time is up"},
        {"/radio_access/who_may_join", json("anyone"), "no keys"},
        {"/radio_access/refused", json{"wifi: 10.0.0.9: revoked"}, "10.0.0.9: revoked"},
        {"/radio_access/different_settings", json{"r2's fleet list is another"}, "r2's fleet list"}}) {
    json report = sound_fleet();
    report[json::json_pointer(pointer)] = value;
    EXPECT_THAT(report_warnings(report, {}), ElementsAre(HasSubstr(words))) << pointer;
  }
}

TEST(ReportWarnings, RobotThatHoldsOnlyTheNodesOfOthersIsNamedWithWhatItsLidarGave) {
  json report = sound_fleet();
  json& r2 = report["agents"]["r2"];
  r2["own_nodes"] = 0;
  r2["sensors"]["scans"] = 0;
  EXPECT_THAT(report_warnings(report, {}), ElementsAre(HasSubstr("r2 made no node: no LiDAR scan arrived")));
  r2["sensors"]["scans"] = 90;
  r2["sensors"]["refused_scans"] = 90;
  EXPECT_THAT(report_warnings(report, {}),
              ElementsAre(HasSubstr("r2 made no node: none of 90 LiDAR scans led to one (90 unusable)")));
  r2["own_nodes"] = 4;
  r2["sensors"]["scans"] = 0;
  EXPECT_THAT(report_warnings(report, {}),
              ElementsAre(HasSubstr("r2 made no node in this run, only before: no LiDAR scan arrived")));
}

TEST(ReportWarnings, MissingSubmapsAreNamedWithTheirMakersAndThatTheMapHasHoles) {
  json report = sound_fleet();
  report["agents"]["r2"]["missing_submaps"] = 4;
  report["agents"]["r2"]["missing_submaps_of"] = {{"r1", 3}, {"r3", 1}};
  EXPECT_THAT(report_warnings(report, {}),
              ElementsAre(HasSubstr("r2: 4 submaps are missing (of r1: 3, r3: 1), so its map has holes")));
}

TEST(ReportWarnings, EqualWarningsOfTwoRobotsAreMerged) {
  json report = sound_fleet();
  for (const char* robot : {"r1", "r2"})
    report["agents"][robot]["alignments_computed_by"] = {{"r3", {{"quarantined", true}}}};
  EXPECT_THAT(report_warnings(report, {}), SizeIs(1));
}

TEST(ReportWarnings, AFrameOfAnotherRobotDoesNotMakeThisOneUnplaced) {
  json agent = sound_fleet()["agents"]["r1"];
  agent["not_georeferenced"] = {"r10", "r2#5"};
  EXPECT_TRUE(has_place_on_earth("r1", agent));
  EXPECT_FALSE(has_place_on_earth("r10", agent));
  EXPECT_FALSE(has_place_on_earth("r2", agent));
}

TEST(ReportWarnings, WithoutAMapNobodyKnowsThePlace) {
  json report = sound_fleet();
  report["agents"]["r1"].erase("not_georeferenced");
  EXPECT_FALSE(has_place_on_earth("r1", report["agents"]["r1"]));
  EXPECT_THAT(report_warnings(report, {}),
              ElementsAre(AllOf(HasSubstr("r1 has no place on Earth"), HasSubstr("map was not written"))));
}

TEST(ReportWarnings, MissingGeoreferenceIsExplainedByTheFixes) {
  json agent = sound_fleet()["agents"]["r1"];
  EXPECT_THAT(why_no_place(agent), HasSubstr("30 of 30 GPS fixes were used, too few"));
  agent["localization"] = {{"fix_used", 0}, {"fix_invalid", 28}, {"fix_gated", 2}, {"fix_implausible", 0}};
  EXPECT_THAT(why_no_place(agent),
              AllOf(HasSubstr("none of 30 GPS fixes could be used (28 invalid, 2 too far"),
                    HasSubstr("no alignment joins it")));
  agent["sensors"]["fixes"] = 0;
  EXPECT_THAT(why_no_place(agent), HasSubstr("no GPS fix arrived (check receiver"));
}

}  // namespace
}  // namespace fleetmap::apps
