// Two robots that meet, from generated recordings whose truth is known: both without GPS and with unknown
// start poses, and one of the two with GPS.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "fleetmap/agent/trajectory_file.hpp"
#include "support/generated_fleet.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap {
namespace {

const std::string kFleetmap = std::string(FLEETMAP_BINARY_DIR) + "/bin/fleetmap";

class GpsFreeFleet : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<testing::TemporaryFolder>();
    auto fleet = testing::write_generated_fleet(folder_->path() / "bags");
    ASSERT_TRUE(fleet) << fleet.error().message;
    fleet_ = std::move(*fleet);
  }
  static void TearDownTestSuite() { folder_.reset(); }

  /// `r1_keys`: what r1 has besides; nobody hears the fixes unless a robot says so.
  nlohmann::json run(const std::string& name, const std::string& r1_keys) {
    folder_->write(name + ".yaml",
                   "site: {origin: [49.0, 8.4, 110.0]}\n"
                   "defaults:\n  lidar: {translation: [0, 0, 0.8]}\n  nodes: {spacing: 4}\n"
                   "  topics: {fix: /nothing}\n"
                   "agents:\n  - id: r1\n    recording: {path: bags/r1}\n" +
                       r1_keys + "  - id: r2\n    recording: {path: bags/r2}\n");
    out_ = folder_->path() / name;
    testing::Process process(
        {kFleetmap, "run", "-c", (folder_->path() / (name + ".yaml")).string(), "--out", out_.string()},
        folder_->path() / (name + ".log"));
    EXPECT_EQ(process.wait(), 0) << process.output();
    std::ifstream file(out_ / "report.json");
    return nlohmann::json::parse(file, nullptr, false);
  }
  Pose first_pose(const std::string& robot) const {
    const auto placed = agent::read_trajectory(out_ / robot / "trajectory.tum");
    return placed && !placed->empty() ? placed->front().T_w_base : Pose::Identity();
  }
  /// Where r2 began as seen from where r1 began, against the truth.
  Pose relative_error() const {
    const Pose truth = fleet_.robots[0].T_enu_base.front().inverse() * fleet_.robots[1].T_enu_base.front();
    return truth.inverse() * first_pose("r1").inverse() * first_pose("r2");
  }

  static std::unique_ptr<testing::TemporaryFolder> folder_;
  static testing::GeneratedFleet fleet_;
  std::filesystem::path out_;
};
std::unique_ptr<testing::TemporaryFolder> GpsFreeFleet::folder_;
testing::GeneratedFleet GpsFreeFleet::fleet_;

TEST_F(GpsFreeFleet, TwoRobotsThatMeetMakeOneMapThatLiesNowhere) {
  const auto report = run("none", "");
  ASSERT_TRUE(report.is_object());
  const auto& r1 = report["agents"]["r1"];
  EXPECT_EQ(r1["aligned_groups"].size(), 1u) << r1.dump();
  EXPECT_EQ(r1["map_hash"], report["agents"]["r2"]["map_hash"]);
  EXPECT_EQ(r1["not_georeferenced"], nlohmann::json({"r1", "r2"}));
  EXPECT_LT(relative_error().translation().norm(), 0.5);
  EXPECT_LT(so3_log(relative_error().linear()).norm() * 180.0 / std::numbers::pi, 1.5);
}

TEST_F(GpsFreeFleet, AFixOfOneRobotGeoreferencesBoth) {
  const auto report = run("one", "    topics: {fix: /fix}\n");
  ASSERT_TRUE(report.is_object());
  EXPECT_EQ(report["agents"]["r2"]["aligned_groups"].size(), 1u);
  EXPECT_TRUE(report["agents"]["r2"]["not_georeferenced"].empty());
  EXPECT_LT(relative_error().translation().norm(), 0.5);
  // GPS of the recording is off by 1.5 m for a minute at a time.
  const LocalFrame truth(fleet_.origin);
  const LocalFrame site(geo_point_from_degrees(49.0, 8.4, 110.0));
  const Eigen::Vector3d placed = truth.to_enu(site.to_geo(first_pose("r2").translation()));
  EXPECT_LT((placed - fleet_.robots[1].T_enu_base.front().translation()).head<2>().norm(), 6.0);
}

}  // namespace
}  // namespace fleetmap
