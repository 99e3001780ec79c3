// The whole pipeline on a real drive: two robots in virtual time become one map.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "apps/kitti_drive.hpp"
#include "fleetmap/output/trajectory_file.hpp"
#include "odometry/trajectory_error.hpp"
#include "support/command_line.hpp"
#include "support/generated_fleet.hpp"
#include "support/measured.hpp"
#include "support/process.hpp"
#include "support/shared_data.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap {
namespace {

std::vector<Pose> poses_of(const std::filesystem::path& file) {
  std::vector<Pose> poses;
  const auto read = output::read_growing_tum(file);
  EXPECT_TRUE(read) << (read ? "" : read.error().message);
  if (read) {
    for (const output::StampedPose& pose : *read) poses.push_back(pose.T_w_base);
  }
  return poses;
}

class KittiFleet : public ::testing::Test {
 protected:
  void SetUp() override {
    drive_ = testing::shared_data(testing::kKittiDrive);
    if (!drive_) GTEST_SKIP() << "recording " << testing::kKittiDrive << " is not here";
    consensus_ = poses_of(*drive_ / "derived/lidar_odometry_consensus_tum_10hz_nominal.txt");
    ASSERT_EQ(consensus_.size(), 154u);
  }
  /// Runs the program to its end and returns what it printed.
  std::string run(std::vector<std::string> arguments, int expected_exit_code = 0) {
    arguments.insert(arguments.begin(), testing::kProgram);
    testing::Process process(arguments);
    EXPECT_EQ(process.wait(), expected_exit_code) << process.output();
    return process.output();
  }

  /// The consensus at the scans of one robot, whose first is frame `first` of the drive.
  testing::GeneratedRobot reference(const std::filesystem::path& out, const std::string& id,
                                    std::size_t first) const {
    testing::GeneratedRobot robot{id, {}, {}};
    const auto scans = output::read_growing_tum(out / id / "odometry.tum");
    EXPECT_TRUE(scans);
    for (std::size_t k = 0; scans && k < scans->size() && first + k < consensus_.size(); ++k) {
      robot.stamps.push_back((*scans)[k].stamp);
      robot.T_enu_base.push_back(consensus_[first + k]);
    }
    return robot;
  }

  /// The delivered fleet, its receivers' errors drawn from other seeds.
  std::filesystem::path fleet_with_gps_errors(unsigned seed) const {
    YAML::Node fleet = YAML::LoadFile(std::string(FLEETMAP_SOURCE_DIR) + "/config/fleets/kitti_0005.yaml");
    for (unsigned k = 0; k < 2; ++k) fleet["agents"][k]["recording"]["gps_error"]["seed"] = 2 * seed - 1 + k;
    const std::filesystem::path file = folder_.path() / ("fleet_" + std::to_string(seed) + ".yaml");
    std::ofstream(file) << fleet;
    return file;
  }
  void two_halves_become_one_map(unsigned seed);

  testing::TemporaryFolder folder_;
  std::optional<std::filesystem::path> drive_;
  std::vector<Pose> consensus_;
};

TEST_F(KittiFleet, OdometryStaysNearTheConsensusOfOthers) {
  const std::filesystem::path tum = folder_.path() / "odometry.tum";
  run({"odometry", drive_->string(), "--out", tum.string(), "--set", "lidar.model=hdl64e"});
  const std::vector<Pose> poses = poses_of(tum);
  ASSERT_EQ(poses.size(), consensus_.size());
  testing::expect_at_most(testing::aligned_rmse(poses, consensus_), 0.040, "odometry RMSE in m", 1);
}

namespace {

void expect_equal_and_complete_maps(const nlohmann::json& report) {
  EXPECT_TRUE(report["exchange_ended"].get<bool>());
  const auto& r1 = report["agents"]["r1"];
  const auto& r2 = report["agents"]["r2"];
  EXPECT_EQ(r1["map_hash"], r2["map_hash"]);
  EXPECT_EQ(r1["nodes"], r2["nodes"]);
  EXPECT_EQ(r1["missing_submaps"], 0);
  EXPECT_EQ(r2["missing_submaps"], 0);
  EXPECT_GT(r1["map_points"].get<std::size_t>(), 100'000u);
  EXPECT_EQ(r1["aligned_groups"].size(), 1u) << "both robots are tied together: " << r1["aligned_groups"];
  // 69 m of which 15 m twice, a node every 3 m and one at each end.
  EXPECT_NEAR(r1["nodes"].get<double>(), 84.0 / 3.0 + 4.0, 8.0);

  for (const auto& agent : {r1, r2}) {
    EXPECT_EQ(agent["sensors"]["refused_messages"], 0);
    EXPECT_EQ(agent["sensors"]["lost_scans"], 0);
    EXPECT_GE(agent["registrations"]["accepted"].get<int>(), 1);
    EXPECT_GE(agent["exchange"]["clouds_received"].get<int>(), 1);
    EXPECT_GT(agent["largest_cloud_bytes"].get<std::size_t>(), 10'000u) << "the budget is used";
    EXPECT_LE(agent["largest_cloud_bytes"].get<std::size_t>(), 25'000u);
  }
}

}  // namespace

void KittiFleet::two_halves_become_one_map(unsigned seed) {
  const std::filesystem::path out = folder_.path() / ("out_" + std::to_string(seed));
  run({"run", "-c", fleet_with_gps_errors(seed).string(), "--out", out.string(), "--set",
       "recording.path=" + drive_->string()});
  std::ifstream file(out / "report.json");
  const auto report = nlohmann::json::parse(file);
  expect_equal_and_complete_maps(report);

  // r2's odometry frame in that of r1: frames 60 and 0 of the drive.
  const std::vector<Pose> t1 = poses_of(out / "r1/trajectory.tum");
  const std::vector<Pose> t2 = poses_of(out / "r2/trajectory.tum");
  ASSERT_EQ(t1.size(), 96u);
  ASSERT_EQ(t2.size(), 94u);
  const Pose T_12 = t1.front().inverse() * t2.front();
  const Pose truth = consensus_[0].inverse() * consensus_[60];
  const Pose error = truth.inverse() * T_12;
  testing::expect_at_most(error.translation().norm(), 0.112, "r2 as seen from r1, m", seed);
  testing::expect_at_most(so3_log(error.linear()).norm() * 180.0 / std::numbers::pi, 0.64,
                          "r2 as seen from r1, deg", seed);
  // Errors of alignments that each robot computed of the other can cancel in the placement.
  const auto store = store::Store::open_read_only(out / "r1" / "store.db");
  ASSERT_TRUE(store) << store.error().message;
  const auto alignments =
      testing::errors_of_alignments(*store, {{}, {reference(out, "r1", 0), reference(out, "r2", 60)}});
  EXPECT_GE(alignments.count, 1);
  testing::expect_at_most(alignments.translation, 0.223, "worst alignment, m", seed);
  testing::expect_at_most(alignments.rotation * 180.0 / std::numbers::pi, 0.84, "worst alignment, deg", seed);

  for (const char* name :
       {"odometry.tum", "ekf.tum", "trajectory.tum", "map.ply", "map.pcd", "alignments.csv", "store.db"}) {
    EXPECT_TRUE(std::filesystem::exists(out / "r1" / name)) << name;
  }
}

TEST_F(KittiFleet, TwoHalvesOfADriveBecomeOneMap) {
  for (unsigned seed = 1; seed <= testing::seeds_to_run(1); ++seed) two_halves_become_one_map(seed);
}

TEST_F(KittiFleet, SameRunSameBytes) {
  std::vector<std::string> hashes;
  for (const char* name : {"a", "b"}) {
    const std::filesystem::path out = folder_.path() / name;
    run({"run", "-c", std::string(FLEETMAP_SOURCE_DIR) + "/config/fleets/kitti_0005.yaml", "--out",
         out.string(), "--set", "recording.path=" + drive_->string(), "--set", "recording.frames=[60,90]",
         "--set", "nodes.spacing=2"});
    std::ifstream file(out / "report.json");
    hashes.push_back(nlohmann::json::parse(file)["agents"]["r1"]["map_hash"]);
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

}  // namespace
}  // namespace fleetmap
