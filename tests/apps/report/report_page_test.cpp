#include "report/report_page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fleetmap::apps {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

json robot_part() {
  return {{"nodes", 8},
          {"own_nodes", 4},
          {"submaps", 4},
          {"alignments", 2},
          {"map_points", 1000},
          {"map_hash", "0123456789abcdef"},
          {"not_georeferenced", json::array()},
          {"sensors", {{"fixes", 30}, {"scans", 90}, {"imu", 900}, {"wheel", 450}, {"missing_scans", 1}}},
          {"localization", {{"fix_used", 29}}},
          {"exchange", {{"long_range_wire_bytes", 6000}}}};
}

/// Two robots that drove 20 m east in 10 s.
ReportFacts two_robots() {
  ReportFacts facts;
  facts.title = "a run";
  facts.report = {{"virtual_time_s", 20.0}, {"agents", {{"r1", robot_part()}, {"r2", robot_part()}}}};
  for (const char* robot : {"r1", "r2"}) {
    RobotTrack& track = facts.tracks.emplace_back();
    track.robot = robot;
    for (int k = 0; k <= 10; ++k) {
      track.poses.push_back({stamp_from_ns(1'800'000'000'000'000'000 + 1'000'000'000LL * k),
                             make_pose(Eigen::Matrix3d::Identity(), Eigen::Vector3d(2.0 * k, 0.0, 0.0))});
    }
  }
  return facts;
}

TEST(ReportPage, WarningsComeBeforeAllElse) {
  ReportFacts facts = two_robots();
  EXPECT_THAT(report_page(facts).str(), HasSubstr("<h2>Warnings</h2>\n<p>None.</p>"));
  facts.report["agents"]["r2"]["sensors"]["findings"] = {"IMU in g: set the driver to m/s^2"};
  const std::string page = report_page(facts).str();
  EXPECT_LT(page.find("<li>r2: IMU in g: set the driver to m/s^2</li>"), page.find("<h2>Map</h2>"));
  EXPECT_THAT(page, Not(HasSubstr("None.")));
  EXPECT_THAT(page, HasSubstr("<td>IMU in g: set the driver to m/s^2</td>")) << "and as the sensors' verdict";
}

TEST(ReportPage, DistanceDurationAndAreaAreThoseOfTheRun) {
  ReportFacts facts = two_robots();
  facts.mapped_area = 812.0;
  EXPECT_THAT(report_page(facts).str(),
              HasSubstr("2 robots drove 40 m in 10 s (with pauses) and mapped 812 m² of ground"));
  EXPECT_THAT(report_page(facts).str(), HasSubstr("First pose: 2027-01-15T08:00:00.000Z"));
}

TEST(ReportPage, RadioUseIsByKindAndAgainstTheBudget) {
  ReportFacts facts = two_robots();
  EXPECT_THAT(report_page(facts).str(), HasSubstr("Nothing was sent."));
  facts.long_range_rate = 12'000.0;
  for (const char* robot : {"r1", "r2"}) {
    facts.report["links"].push_back({{"agent", robot},
                                     {"link", "long_range"},
                                     {"topic", std::string("fleetmap/node/") + robot},
                                     {"messages", 3},
                                     {"wire_bytes", 1500}});
  }
  const std::string page = report_page(facts).str();
  EXPECT_THAT(page, HasSubstr("<tr><td>long range</td><td>node</td><td>6</td><td>3</td></tr>"));
  EXPECT_THAT(page, HasSubstr("12 kB in 20 s, on average 5 % of the 12 kB/s"));
  facts.report.erase("virtual_time_s");
  facts.report["uptime_s"] = 40.0;
  EXPECT_THAT(report_page(facts).str(), HasSubstr("12 kB in 40 s, on average 2.5 %")) << "a live robot";
}

TEST(ReportPage, PairsAreToldWithTheirReason) {
  ReportFacts facts = two_robots();
  monitor::PairAnswer& pair = facts.pairs.emplace_back();
  pair.a = AgentId::parse("r1").value();
  pair.b = AgentId::parse("r2").value();
  pair.state = monitor::PairState::joined;
  pair.text = "7 alignments join them.";
  pair.used = 7;
  pair.attempts = 9;
  pair.accepted = 8;
  EXPECT_THAT(report_page(facts).str(),
              HasSubstr("<td>r1 - r2</td><td>yes</td><td>7</td><td>9</td><td>8</td><td>7 alignments"));
}

TEST(ReportPage, TheTracksSayWhoseFrameLiesNowhere) {
  ReportFacts facts = two_robots();
  EXPECT_THAT(report_page(facts).str(), HasSubstr("Trajectories in ENU, north up"));
  EXPECT_THAT(report_page(facts).str(), HasSubstr("north [m]"));
  facts.report["agents"]["r2"]["not_georeferenced"] = {"r2"};
  facts.report["agents"]["r2"]["sensors"]["fixes"] = 0;
  const std::string one = report_page(facts).str();
  EXPECT_THAT(one, HasSubstr("north up, but those of r2: their place on Earth is unknown"));
  EXPECT_THAT(one, HasSubstr("<td>r1</td><td>yes</td><td>30</td><td>29</td>"));
  EXPECT_THAT(
      one, HasSubstr("<td>r2</td><td>no</td><td>0</td><td>29</td><td class=\"sentence\">no GPS fix arrived"));
  facts.report["agents"]["r1"]["not_georeferenced"] = {"r1#3"};
  const std::string none = report_page(facts).str();
  EXPECT_THAT(none, HasSubstr("no robot has a place on Earth, so north is unknown"));
  EXPECT_THAT(none, Not(HasSubstr("north [m]")));
}

TEST(ReportPage, NoLineJoinsTheSessionsOfATrack) {
  const auto lines_of = [](const ReportFacts& facts) {
    const std::string page = report_page(facts).str();
    int lines = 0;
    for (auto at = page.find("<polyline"); at != std::string::npos; at = page.find("<polyline", at + 1))
      ++lines;
    EXPECT_THAT(page, Not(HasSubstr("nan")));
    return lines;
  };
  ReportFacts facts = two_robots();
  const int before = lines_of(facts);
  for (std::size_t k = 5; k <= 10; ++k) facts.tracks[0].poses[k].stamp += std::chrono::hours(24);
  EXPECT_EQ(lines_of(facts), before + 1);
}

TEST(ReportPage, RobotWithoutANodeOfItsOwnIsNotGeoreferenced) {
  ReportFacts facts = two_robots();
  json& r2 = facts.report["agents"]["r2"];
  r2["own_nodes"] = 0;
  r2["sensors"] = {{"scans", 0}, {"fixes", 0}};
  const std::string page = report_page(facts).str();
  EXPECT_THAT(page, HasSubstr("<td>r2</td><td>no</td><td>0</td><td>29</td><td class=\"sentence\">"
                              "it made no node: no LiDAR scan arrived"));
  EXPECT_THAT(page, Not(HasSubstr("None.")));
  EXPECT_THAT(page, HasSubstr("<td class=\"sentence\">no LiDAR scan arrived")) << "as its sensors' verdict";
}

TEST(ReportPage, NamesThatAreNoUtf8DoNotLoseTheReport) {
  ReportFacts facts = two_robots();
  facts.report["settings"] = {{"configuration", "caf\xe9.yaml"}};
  EXPECT_THAT(report_page(facts).str(), HasSubstr("caf\xef\xbf\xbd.yaml"));
}

TEST(ReportPage, NothingFromOutsideBecomesMarkup) {
  const std::string hostile = "<script>alert(1)</script>\"'&";
  ReportFacts facts = two_robots();
  facts.title = hostile;
  facts.why_no_plan = hostile;
  json part = robot_part();
  part["problem"] = part["map_hash"] = hostile;
  part["sensors"]["findings"] = {hostile};
  part["bus_drops"] = {{hostile, 1}};
  part["exchange"]["misbehaved"] = {{hostile, 1}};
  facts.report["agents"][hostile] = part;
  facts.report["links"].push_back(
      {{"link", hostile}, {"topic", hostile}, {"messages", 1}, {"wire_bytes", 1}});
  facts.report["completion"] = {{"why_not", hostile}};
  facts.report["settings"] = {{"version", hostile}, {"configuration", hostile}, {"set", {hostile}}};
  facts.tracks[0].robot = hostile;
  monitor::PairAnswer& pair = facts.pairs.emplace_back();
  pair.text = hostile;
  const std::string page = report_page(facts).str();
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_THAT(page, HasSubstr("&lt;script&gt;"));
}

TEST(ReportPage, NeedsNoOtherFile) {
  const std::string page = report_page(two_robots()).str();
  for (const char* outside : {"src=\"http", "href", "<link", "@import", "url("})
    EXPECT_THAT(page, Not(HasSubstr(outside))) << outside;
}

TEST(ReportPage, ARunThatLeftNothingHasAPage) {
  EXPECT_THAT(report_page(ReportFacts{}).str(), HasSubstr("There is no map to show."));
}

}  // namespace
}  // namespace fleetmap::apps
