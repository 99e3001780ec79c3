// Two robots that meet, from generated recordings whose truth is known: both without GPS and with unknown
// start poses, and one of the two with GPS.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

#include "fleetmap/output/trajectory_file.hpp"
#include "odometry/trajectory_error.hpp"
#include "support/command_line.hpp"
#include "support/generated_fleet.hpp"
#include "support/measured.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap {
namespace {

class GpsFreeFleet : public ::testing::Test {
 protected:
  nlohmann::json run(const std::set<std::string>& without_gps) {
    auto fleet = testing::write_generated_fleet(folder_.path() / "bags", without_gps);
    EXPECT_TRUE(fleet);
    if (!fleet) return {};
    fleet_ = std::move(*fleet);
    const auto file = folder_.write("fleet.yaml",
                                    "site: {origin: [48.2, 11.6, 500.0]}\n"
                                    "defaults:\n  lidar: {translation: [0, 0, 0.8]}\n  nodes: {spacing: 4}\n"
                                    "agents:\n  - id: r1\n    recording: {path: bags/r1}\n"
                                    "  - id: r2\n    recording: {path: bags/r2}\n");
    testing::Process process({testing::kProgram, "run", "-c", file.string(), "--out", out_.string()});
    EXPECT_EQ(process.wait(), 0) << process.output();
    std::ifstream report(out_ / "report.json");
    return nlohmann::json::parse(report, nullptr, false);
  }
  Pose first_pose(const std::string& robot) const {
    const auto placed = output::read_growing_tum(out_ / robot / "trajectory.tum");
    return placed && !placed->empty() ? placed->front().T_w_base : Pose::Identity();
  }
  /// Error of the start of r2 relative to that of r1, against the truth.
  Pose relative_error() const {
    const Pose truth = fleet_.robots[0].T_enu_base.front().inverse() * fleet_.robots[1].T_enu_base.front();
    return truth.inverse() * first_pose("r1").inverse() * first_pose("r2");
  }
  /// Bounds: docs/reference/test_bounds.md.
  void expect_relative_error(const std::string& what) const {
    const Pose error = relative_error();
    testing::expect_at_most(error.translation().norm(), 0.025, what + ": r2 seen from r1, m", 1);
    testing::expect_at_most(so3_log(error.linear()).norm() * 180.0 / std::numbers::pi, 0.195,
                            what + ": r2 seen from r1, deg", 1);
    // The first poses alone would not show a track that is bent.
    std::vector<Pose> placed, truth;
    for (const testing::GeneratedRobot& robot : fleet_.robots) {
      const auto track = output::read_growing_tum(out_ / robot.id / "trajectory.tum");
      ASSERT_TRUE(track) << track.error().message;
      for (const output::StampedPose& pose : *track) placed.push_back(pose.T_w_base);
      truth.insert(truth.end(), robot.T_enu_base.begin(), robot.T_enu_base.end());
    }
    ASSERT_EQ(placed.size(), truth.size());
    testing::expect_at_most(testing::aligned_rmse(placed, truth), 0.0020, what + ": joint ATE, m", 1);
    // The graph corrects a rotation by the positions of several alignments, so each is looked at alone too.
    const auto store = store::Store::open_read_only(out_ / "r1" / "store.db");
    ASSERT_TRUE(store) << store.error().message;
    const auto alignments = testing::errors_of_alignments(*store, fleet_);
    EXPECT_GE(alignments.count, 1);
    testing::expect_at_most(alignments.translation, 0.0030, what + ": worst alignment, m", 1);
    testing::expect_at_most(alignments.rotation * 180.0 / std::numbers::pi, 0.0206,
                            what + ": worst alignment, deg", 1);
  }

  testing::TemporaryFolder folder_;
  testing::GeneratedFleet fleet_;
  std::filesystem::path out_ = folder_.path() / "out";
};

TEST_F(GpsFreeFleet, TwoRobotsThatMeetMakeOneMapThatLiesNowhere) {
  const auto report = run({"r1", "r2"});
  ASSERT_TRUE(report.is_object());
  const auto& r1 = report["agents"]["r1"];
  EXPECT_EQ(r1["aligned_groups"].size(), 1u) << r1.dump();
  EXPECT_EQ(r1["not_georeferenced"], nlohmann::json({"r1", "r2"}));
  EXPECT_EQ(r1["map_hash"], report["agents"]["r2"]["map_hash"]) << "both hold all submaps in the end";
  EXPECT_EQ(r1["missing_submaps"], 0);
  expect_relative_error("nobody has GPS");
}

TEST_F(GpsFreeFleet, AFixOfOneRobotGeoreferencesBoth) {
  const auto report = run({"r2"});
  ASSERT_TRUE(report.is_object());
  EXPECT_EQ(report["agents"]["r2"]["aligned_groups"].size(), 1u);
  EXPECT_TRUE(report["agents"]["r2"]["not_georeferenced"].empty());
  EXPECT_EQ(report["agents"]["r1"]["map_hash"], report["agents"]["r2"]["map_hash"]);
  expect_relative_error("one has GPS");
  // GPS of the recording is off by 1.5 m for a minute at a time.
  const LocalFrame truth(fleet_.origin);
  const LocalFrame site(geo_point_from_degrees(48.2, 11.6, 500.0));
  const Eigen::Vector3d placed = truth.to_enu(site.to_geo(first_pose("r2").translation()));
  const Eigen::Vector3d off = placed - fleet_.robots[1].T_enu_base.front().translation();
  testing::expect_at_most(off.head<2>().norm(), 6.0, "one has GPS: where the map lies, m", 1);
}

}  // namespace
}  // namespace fleetmap
