#include "report/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "fleetmap/output/trajectory_file.hpp"
#include "store/items.hpp"
#include "support/file_content.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

TEST(LostWays, AreASentenceWithBothCounts) {
  odometry::LoamCounters odometry;
  odometry.updates = 90;
  EXPECT_EQ(lost_ways(odometry), "");
  odometry.lost = 7;
  EXPECT_THAT(lost_ways(odometry), HasSubstr("7 of 90 scans did not fit"));
  EXPECT_THAT(lost_ways(odometry), Not(HasSubstr("anew")));
  odometry.map_restarts = 2;
  EXPECT_THAT(lost_ways(odometry), HasSubstr("began anew 2 times"));
}

/// Two robots that were switched off to the end; each left a trajectory.
class FleetReport : public ::testing::Test {
 protected:
  FleetReport() {
    for (const char* name : {"r1", "r2"}) {
      auto& entry = outcome_.agents.emplace_back();
      entry.id = testing::agent(name);
      entry.results.emplace();
      std::filesystem::create_directories(folder_.path() / name);
      const output::Trajectory track{
          {stamp_from_ns(1), Pose::Identity()},
          {stamp_from_ns(2), make_pose(Eigen::Matrix3d::Identity(), Eigen::Vector3d(9.0, 0.0, 0.0))}};
      EXPECT_TRUE(output::write_tum(folder_.path() / name / "trajectory.tum", track));
    }
  }
  nlohmann::json written() {
    const Status done =
        write_report(folder_.path(), outcome_, RunProfile{}, {"1.2 abc", "farm.yaml", {"seed=2"}});
    EXPECT_TRUE(done) << done.error().message;
    page_ = testing::file_text(folder_.path() / "report.html");
    return nlohmann::json::parse(testing::file_text(folder_.path() / "report.json"));
  }

  testing::TemporaryFolder folder_;
  FleetOutcome outcome_;
  std::string page_;
};

TEST_F(FleetReport, TellsOfAMissionThatWasNotCompletedWhyAndWhichRows) {
  EXPECT_FALSE(written().contains("completion"));
  Completion& completion = outcome_.completion.emplace();
  completion.rows_driven = 120.5;
  completion.why_not = "two robots are not joined";
  completion.abandoned = {{7, testing::agent("r1"), "a tree stands in it"},
                          {7, testing::agent("r2"), ""},
                          {9, testing::agent("r2"), ""}};
  const auto json = written()["completion"];
  EXPECT_EQ(json["mission_s"], 120.5);
  EXPECT_TRUE(json["aligned_s"].is_null());
  EXPECT_EQ(json["why_not"], "two robots are not joined");
  EXPECT_EQ(json["abandoned"], 2) << "rows, not robots that gave them up";
  ASSERT_THAT(json["abandoned_rows"], SizeIs(3));
  EXPECT_EQ(json["abandoned_rows"][0]["why"], "a tree stands in it");
  EXPECT_EQ(json["abandoned_rows"][2]["why"], "no robot was left to drive it");
}

TEST_F(FleetReport, TheBytesOfEachLinkAreThere) {
  outcome_.links = {{testing::agent("r1"), bus::Link::kLongRange, "fleetmap/node"}};
  outcome_.links[0].copies = 3;
  outcome_.links[0].wire_bytes = 1410;
  outcome_.links[0].airtime = std::chrono::milliseconds(56);
  const auto links = written()["links"];
  ASSERT_THAT(links, SizeIs(1));
  EXPECT_EQ(links[0]["agent"], "r1");
  EXPECT_EQ(links[0]["wire_bytes"], 1410);
  EXPECT_EQ(links[0]["airtime_s"], 0.056);
}

TEST_F(FleetReport, DamageOfARecordingIsAWarning) {
  outcome_.agents[1].recording.damaged_parts = 1;
  EXPECT_EQ(written()["agents"]["r2"]["recording"]["damaged_parts"], 1);
  EXPECT_THAT(page_, HasSubstr("<li>r2: 1 part of the recording is damaged or cut off"));
  EXPECT_THAT(page_, Not(HasSubstr("<li>r1: 1 part")));
}

TEST_F(FleetReport, AFindingOfARecordingsReaderIsAWarning) {
  outcome_.agents[1].recording_findings = {"LiDAR: two on one topic"};
  outcome_.agents[1].recording.damaged_parts = 1;
  EXPECT_EQ(written()["agents"]["r2"]["recording"]["findings"].size(), 2u);
  EXPECT_THAT(page_, HasSubstr("<li>r2: LiDAR: two on one topic"));
}

TEST_F(FleetReport, VersionAndSettingsAreThere) {
  const auto settings = written()["settings"];
  EXPECT_EQ(settings["version"], "1.2 abc");
  EXPECT_EQ(settings["configuration"], "farm.yaml");
  EXPECT_EQ(settings["set"], nlohmann::json({"seed=2"}));
  EXPECT_THAT(page_, HasSubstr("fleetmap 1.2 abc, configuration farm.yaml."));
}

TEST_F(FleetReport, ThePageShowsTheTracksOfTheFolder) {
  written();
  EXPECT_THAT(page_, HasSubstr("2 robots drove 18 m in"));
  EXPECT_THAT(page_, HasSubstr("no robot has a place on Earth")) << "none has a map";
}

TEST_F(FleetReport, RobotThatIsOffHasAProblemInTheReport) {
  outcome_.agents[1].problem = "its store is damaged";
  const auto agents = written()["agents"];
  EXPECT_TRUE(agents["r2"]["switched_off"]);
  EXPECT_EQ(agents["r2"]["problem"], "its store is damaged");
  EXPECT_FALSE(agents["r1"].contains("problem"));
  EXPECT_THAT(page_, HasSubstr("r2 (switched off)"));
}

}  // namespace
}  // namespace fleetmap::apps
