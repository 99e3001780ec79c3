// The whole pipeline on a generated recording whose truth is known; needs nothing but this project.
#include "support/generated_fleet.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "fleetmap/output/trajectory_file.hpp"
#include "fleetmap/recording/bag_writer.hpp"
#include "fleetmap/ros_codec/point_cloud2.hpp"
#include "fleetmap/ros_codec/topics.hpp"
#include "odometry/trajectory_error.hpp"
#include "support/command_line.hpp"
#include "support/file_content.hpp"
#include "support/measured.hpp"
#include "support/process.hpp"
#include "support/synthetic_lidar.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap {
namespace {

/// The recording of the run gives the same odometry as its input, and states the mount itself.
void expect_same_odometry_of_recorded(const std::filesystem::path& folder) {
  for (const char* bags : {"bags", "recorded"}) {
    std::vector<std::string> arguments{testing::kProgram, "odometry", (folder / bags / "r1").string(),
                                       "--out", (folder / bags / "r1.tum").string()};
    if (std::string(bags) == "bags")
      arguments.insert(arguments.end(), {"--set", "lidar.translation=[0,0,0.8]"});
    testing::Process odometry(arguments);
    ASSERT_EQ(odometry.wait(), 0) << odometry.output();
  }
  EXPECT_FALSE(testing::file_text(folder / "bags/r1.tum").empty());
  EXPECT_TRUE(testing::file_text(folder / "bags/r1.tum") == testing::file_text(folder / "recorded/r1.tum"));
}

/// The recording of a robot has all that ROS 2's tools would have shown.
void expect_recorded_outputs(const std::filesystem::path& bag) {
  const std::string metadata = testing::file_text(bag / "metadata.yaml");
  for (const bus::Topic& topic : ros_codec::topics::outputs())
    EXPECT_THAT(metadata, ::testing::HasSubstr("name: " + topic.name.substr(2) + "\n"))
        << "rt/ is not in bags";
}

/// The graph corrects a rotation by the positions of several alignments, so each is compared alone, too.
void expect_true_alignments(const std::filesystem::path& file, const testing::GeneratedFleet& fleet) {
  const auto store = store::Store::open_read_only(file);
  ASSERT_TRUE(store) << store.error().message;
  const auto alignments = testing::errors_of_alignments(*store, fleet);
  EXPECT_GE(alignments.count, 1);
  testing::expect_at_most(alignments.translation, 0.0021, "worst alignment, m", 1);
  testing::expect_at_most(alignments.rotation * 180.0 / std::numbers::pi, 0.0165, "worst alignment, deg", 1);
}

TEST(GeneratedFleet, TwoRobotsThatMeetMakeOneMap) {
  const testing::TemporaryFolder folder;
  const auto fleet = testing::write_generated_fleet(folder.path() / "bags");
  ASSERT_TRUE(fleet) << fleet.error().message;
  const std::filesystem::path out = folder.path() / "out";
  testing::Process process({testing::kProgram, "run", "--recording",
                            "r1=" + (folder.path() / "bags/r1").string(), "--recording",
                            "r2=" + (folder.path() / "bags/r2").string(), "--out", out.string(), "--set",
                            "lidar.translation=[0,0,0.8]", "--set", "nodes.spacing=4", "--record",
                            (folder.path() / "recorded").string()});
  ASSERT_EQ(process.wait(), 0) << process.output();
  std::ifstream file(out / "report.json");
  const auto report = nlohmann::json::parse(file);
  EXPECT_TRUE(report["exchange_ended"].get<bool>()) << process.output();
  const auto& r1 = report["agents"]["r1"];
  const auto& r2 = report["agents"]["r2"];
  EXPECT_EQ(r1["map_hash"], r2["map_hash"]);
  EXPECT_EQ(r1["missing_submaps"], 0);
  EXPECT_EQ(r2["missing_submaps"], 0);
  EXPECT_EQ(r1["aligned_groups"].size(), 1u) << process.output();

  std::vector<std::vector<Pose>> trajectories;
  std::vector<Pose> placed_poses, true_poses;
  for (const testing::GeneratedRobot& robot : fleet->robots) {
    const auto odometry = output::read_growing_tum(out / robot.id / "odometry.tum");
    const auto placed = output::read_growing_tum(out / robot.id / "trajectory.tum");
    ASSERT_TRUE(odometry && placed);
    ASSERT_EQ(odometry->size(), robot.T_enu_base.size());
    std::vector<Pose> O, T;
    for (const auto& pose : *odometry) O.push_back(pose.T_w_base);
    for (const auto& pose : *placed) T.push_back(pose.T_w_base);
    testing::expect_at_most(testing::aligned_rmse(O, robot.T_enu_base), 0.0019, "odometry of a robot in m",
                            1);
    placed_poses.insert(placed_poses.end(), T.begin(), T.end());
    true_poses.insert(true_poses.end(), robot.T_enu_base.begin(), robot.T_enu_base.end());
    trajectories.push_back(T);
  }
  expect_same_odometry_of_recorded(folder.path());
  expect_recorded_outputs(folder.path() / "recorded/r1");

  // The start of r2 relative to that of r1 is compared with the truth.
  const Pose T_12 = trajectories[0].front().inverse() * trajectories[1].front();
  const Pose truth = fleet->robots[0].T_enu_base.front().inverse() * fleet->robots[1].T_enu_base.front();
  const Pose error = truth.inverse() * T_12;
  testing::expect_at_most(error.translation().norm(), 0.0283, "r2 as seen from r1, m", 1);
  testing::expect_at_most(so3_log(error.linear()).norm() * 180.0 / std::numbers::pi, 0.19,
                          "r2 as seen from r1, deg", 1);
  testing::expect_at_most(testing::aligned_rmse(placed_poses, true_poses), 0.0018, "joint ATE, m", 1);
  expect_true_alignments(out / "r1" / "store.db", *fleet);
}

/// Writes a recording of a robot that is carried elsewhere between two scans: nothing that it sees then fits
/// its map.
void write_carried_robot(const std::filesystem::path& folder) {
  auto bag = recording::BagWriter::create(folder);
  ASSERT_TRUE(bag) << bag.error().message;
  const testing::SyntheticWorld yard = testing::yard_world(), panels = testing::panel_world();
  const bus::Topic topic = ros_codec::topics::points();
  for (int k = 0; k < 32; ++k) {
    const double seconds = 0.1 * k;
    const bool carried = k >= 12;
    // Each scan from elsewhere, turned by about a right angle: no motion explains these.
    const Pose there =
        make_pose(rotation_from_rpy(0.0, 0.0, carried ? 1.6 * k : 0.0),
                  Eigen::Vector3d(carried ? 3.0 * (k % 5) : 0.0, carried ? 20.0 + 2.5 * k : 0.0, 0.0));
    sensor::Scan scan = make_scan(
        carried ? panels : yard, [&](double) { return there; }, seconds, odometry::vlp16());
    scan.stamp = stamp_from_ns(1'750'000'000'000'000'000) + from_seconds(seconds);
    ASSERT_TRUE(bag->write(topic.name, topic.type, scan.stamp, ros_codec::encode(scan)));
  }
  ASSERT_TRUE(bag->close());
}

TEST(OdometryCommand, ALostWayIsSaidAndFails) {
  const testing::TemporaryFolder folder;
  write_carried_robot(folder.path() / "bag");
  testing::Process odometry({testing::kProgram, "odometry", (folder.path() / "bag").string(), "--out",
                             (folder.path() / "o.tum").string(), "--set", "lidar.translation=[0,0,0.8]"});
  EXPECT_EQ(odometry.wait(), 1);
  EXPECT_THAT(odometry.output(),
              ::testing::ContainsRegex("lost [0-9]+ of 32 scans, the first 1\\.[0-9]+ s after"));
  EXPECT_THAT(odometry.output(), ::testing::HasSubstr("the local map was begun anew"));
  EXPECT_THAT(odometry.output(), ::testing::HasSubstr("the odometry lost its way"));
}

TEST(RunCommand, ALostWayIsInTheLogAndInTheLastLines) {
  const testing::TemporaryFolder folder;
  write_carried_robot(folder.path() / "bag");
  testing::Process run({testing::kProgram, "run", "--recording", "r1=" + (folder.path() / "bag").string(),
                        "--out", (folder.path() / "out").string(), "--set", "lidar.translation=[0,0,0.8]"});
  EXPECT_EQ(run.wait(), 0) << run.output();
  EXPECT_THAT(run.output(), ::testing::HasSubstr("poses are predictions until scans fit again"));
  EXPECT_THAT(run.output(),
              ::testing::ContainsRegex("the odometry lost its way: [0-9]+ of 32 scans did not "
                                       "fit.*it began anew 1 times, each a session of its own"));
}

}  // namespace
}  // namespace fleetmap
