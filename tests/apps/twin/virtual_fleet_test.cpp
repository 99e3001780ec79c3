// A whole mission in the twin in virtual time: from the world's file to equal maps, and the same again.
// Bounds of errors: docs/reference/test_bounds.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <limits>

#include "apps/small_twin.hpp"
#include "fleetmap/config/world_file.hpp"
#include "fleetmap/core/bytes.hpp"
#include "fleetmap/eval/trajectory.hpp"
#include "fleetmap/output/trajectory_file.hpp"
#include "support/command_line.hpp"
#include "support/file_content.hpp"
#include "support/measured.hpp"
#include "support/process.hpp"

namespace fleetmap {
namespace {

namespace fs = std::filesystem;

/// Content hash of a file's bytes; empty if there is none.
std::string hash_of(const fs::path& file) {
  const Bytes bytes = testing::file_bytes(file);
  return bytes.empty() ? "" : to_hex(content_hash(bytes));
}

/// Share of the true poses at which less than `radius` was free around the robot.
double share_touching(const output::Trajectory& truth, const sim::World& world, double radius) {
  const auto touching = std::ranges::count_if(truth, [&](const output::StampedPose& pose) {
    return world.blocked(pose.T_w_base.translation().head<2>(), radius);
  });
  return static_cast<double>(touching) / static_cast<double>(truth.size());
}

/// The result of `fleetmap eval`.
nlohmann::json evaluated(const fs::path& out) {
  testing::Process evaluation({testing::kProgram, "eval", out.string(), "--no-pictures"});
  EXPECT_EQ(evaluation.wait(), 0) << evaluation.output();
  std::ifstream file(out / "evaluation.json");
  return nlohmann::json::parse(file, nullptr, false);
}

void expect_true_map(const nlohmann::json& evaluation, const fs::path& out, unsigned seed) {
  using testing::expect_at_least;
  using testing::expect_at_most;
  const auto at = [&](const char* pointer) {
    const nlohmann::json value = evaluation.value(nlohmann::json::json_pointer(pointer), nlohmann::json());
    EXPECT_TRUE(value.is_number()) << pointer << ", seed " << seed;
    return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
  };
  expect_at_most(at("/modes/fleet/fleet/ate_joint"), 0.0173, "fleet, joint ATE in m", seed);
  expect_at_most(at("/modes/correlation_paper/fleet/ate_joint"), 0.024,
                 "fleet, joint ATE by the paper's placement in m", seed);
  expect_at_most(at("/fleet/ate_unaligned"), 3.35, "fleet, ATE without alignment in m", seed);
  expect_at_most(at("/fleet/inter_robot_translation"), 0.0385, "fleet, relative pose of two robots in m",
                 seed);
  expect_at_most(at("/calibration/ekf/horizontal/nees"), 3.9, "fleet, NEES of the EKF", seed);
  expect_at_most(at("/calibration/odometry/nees"), 1.92, "fleet, NEES of odometry", seed);
  expect_at_most(at("/alignments/calibration/nees"), 1.95, "fleet, NEES of alignments", seed);
  expect_at_most(at("/alignments/errors_of_right/translation/rms"), 0.0261, "fleet, error of alignments in m",
                 seed);
  expect_at_least(at("/alignments/count"), 8, "fleet, alignments", seed);
  expect_at_most(at("/alignments/wrong"), 0, "fleet, wrong alignments", seed);
  expect_at_most(at("/alignments/wrong_used"), 0, "fleet, wrong alignments in use", seed);
  expect_at_most(at("/modes/fleet/fleet/wrong_merges"), 0, "fleet, wrong merges", seed);
  expect_at_most(at("/modes/correlation_paper/fleet/wrong_merges"), 0,
                 "fleet, wrong merges by the paper's placement", seed);
  const double f1 = at("/map/overlap/f1/1"), best = at("/map/overlap/with_true_poses/f1/1");
  expect_at_least(f1, 0.917, "fleet, F1 at 10 cm where two robots were", seed);
  expect_at_most(best - f1, 0.001, "fleet, F1 lost against true poses", seed);
  // Wherever GPS has taken the robots' EKFs, their fleet as a whole is not taken farther.
  std::vector<output::Trajectory> ekf, truths;
  for (const std::string id : {"r1", "r2", "r3"}) {
    const auto one = output::read_tum(out / id / "ekf.tum"), other = output::read_tum(out / id / "truth.tum");
    ASSERT_TRUE(one && other) << id;
    ekf.push_back(*one), truths.push_back(*other);
  }
  const auto errors_of_ekf = eval::compare_jointly(
      std::vector<eval::Track>{{&ekf[0], &truths[0]}, {&ekf[1], &truths[1]}, {&ekf[2], &truths[2]}});
  ASSERT_TRUE(errors_of_ekf) << errors_of_ekf.error().message;
  expect_at_most(at("/fleet/ate_unaligned") / errors_of_ekf->unaligned, 1.0,
                 "fleet, ATE without alignment over that of its EKFs", seed);
  for (const std::string id : {"r1", "r2", "r3"}) {
    const auto truth = output::read_tum(out / id / "truth.tum");
    const auto odometry = output::read_tum(out / id / "odometry.tum");
    ASSERT_TRUE(truth && odometry) << id;
    const auto errors = eval::compare(*odometry, *truth);
    ASSERT_TRUE(errors) << id << ": " << errors.error().message;
    EXPECT_GT(errors->path_length, 15.0) << id << " drove";
    expect_at_most(errors->ate_rmse_aligned, 0.0157, "fleet, odometry of one robot in m", seed);
  }
}

void expect_complete_mission(const nlohmann::json& report) {
  EXPECT_TRUE(report["exchange_ended"].get<bool>());
  const auto& completion = report["completion"];
  ASSERT_TRUE(completion["completed_s"].is_number()) << completion.dump();
  EXPECT_LT(completion["completed_s"].get<double>(), 200.0);
  EXPECT_LE(completion["mission_s"].get<double>(), completion["completed_s"].get<double>());
  EXPECT_GT(completion["lane_share"].get<double>(), 0.93) << "the drawing is off, the lanes are driven";
  EXPECT_EQ(completion["abandoned"], 0);
}

void expect_whole_profile(const nlohmann::json& report) {
  double sum = 0.0;
  const auto& shares = report["profile"]["shares"];
  for (const auto& [part, share] : shares.items()) sum += share.get<double>();
  EXPECT_NEAR(sum, 1.0, 1e-9) << shares.dump();
  for (const char* part : {"rays", "odometry", "registration", "spherization", "placement", "results"})
    EXPECT_GT(shares[part].get<double>(), 0.001) << part;
  EXPECT_LT(shares["rest"].get<double>(), 0.5);
}

/// All robots hold the same whole map and touched nothing.
void expect_equal_maps(const testing::SmallTwin& twin, const testing::SmallTwin::Run& run) {
  const auto world = config::make_world(twin.path("world.yaml"));
  ASSERT_TRUE(world);
  const std::string map_hash = run.report["agents"]["r1"]["map_hash"];
  EXPECT_EQ(run.report["agents"].size(), 3u);
  for (const auto& [id, agent] : run.report["agents"].items()) {
    EXPECT_EQ(agent["map_hash"], map_hash) << id;
    EXPECT_EQ(agent["missing_submaps"], 0) << id;
    EXPECT_EQ(agent["aligned_groups"].size(), 1u) << id;
    EXPECT_GT(agent["map_points"].get<std::size_t>(), 50'000u) << id;
    const auto truth = output::read_tum(run.out / id / "truth.tum");
    ASSERT_TRUE(truth) << id;
    EXPECT_LT(share_touching(*truth, **world, 0.3), 0.02) << id;
  }
}

TEST(VirtualFleet, AMissionEndsWithEqualMapsAndTheSameSeedWithTheSameBytes) {
  const testing::SmallTwin twin;
  const auto two = twin.run("two", {"--threads", "2"});
  ASSERT_EQ(two.exit_code, 0) << two.output;
  ASSERT_TRUE(two.report.is_object());
  EXPECT_TRUE(fs::exists(two.out / "truth.ply"));
  expect_complete_mission(two.report);
  expect_whole_profile(two.report);
  expect_equal_maps(twin, two);

  const nlohmann::json evaluation = evaluated(two.out);
  expect_true_map(evaluation, two.out, 1);
  EXPECT_EQ(evaluation["fleet"]["joined_pairs"], evaluation["fleet"]["joined"].size());
  EXPECT_EQ(evaluation["alignments"]["held"], two.report["agents"]["r1"]["alignments"]);
  EXPECT_GT(evaluation["calibration"]["ekf"]["horizontal"]["count"].get<int>(), 100);
  EXPECT_GT(evaluation["cpu"]["per_robot_s"].get<double>(), 0.0);

  const auto one = twin.run("one", {"--threads", "1"});
  ASSERT_EQ(one.exit_code, 0) << one.output;
  const auto other = twin.run("other", {"--threads", "2", "--set", "world.seed=2"});
  ASSERT_EQ(other.exit_code, 0) << other.output;
  expect_true_map(evaluated(other.out), other.out, 2);
  for (unsigned seed = 3; seed <= testing::seeds_to_run(2); ++seed) {
    const auto more = twin.run("more", {"--set", "world.seed=" + std::to_string(seed)});
    ASSERT_EQ(more.exit_code, 0) << more.output;
    expect_true_map(evaluated(more.out), more.out, seed);
    fs::remove_all(more.out);
  }
  EXPECT_NE(hash_of(two.out / "truth.ply"), hash_of(other.out / "truth.ply"));
  for (const std::string id : {"r1", "r2", "r3"}) {
    for (const char* file : {"map.ply", "odometry.tum", "trajectory.tum", "alignments.csv", "truth.tum"}) {
      const std::string hash = hash_of(two.out / id / file);
      EXPECT_FALSE(hash.empty()) << id << "/" << file;
      EXPECT_EQ(hash, hash_of(one.out / id / file)) << id << "/" << file << " with one thread";
      EXPECT_NE(hash, hash_of(other.out / id / file)) << id << "/" << file << " of another seed";
    }
  }
}

TEST(VirtualFleet, AMissionEndsThoughThingsStandInTheWayThatNobodyDrew) {
  const testing::SmallTwin twin;
  const auto clear = twin.run("clear", {"--set", "max_time=1", "--set", "mission.map_error_m=1"});
  ASSERT_EQ(clear.exit_code, 0) << clear.output;
  const auto cluttered =
      twin.run("cluttered", {"--set", "mission.unknown_obstacles=3", "--set", "mission.map_error_m=1"});
  ASSERT_EQ(cluttered.exit_code, 0) << cluttered.output;
  EXPECT_EQ(hash_of(clear.out / "site.geojson"), hash_of(cluttered.out / "site.geojson"))
      << "not in the drawing";
  EXPECT_NE(hash_of(clear.out / "truth.ply"), hash_of(cluttered.out / "truth.ply")) << "but in the world";
  const auto& completion = cluttered.report["completion"];
  ASSERT_TRUE(completion["completed_s"].is_number()) << completion.dump();
  EXPECT_LT(completion["completed_s"].get<double>(), 300.0);
  EXPECT_GT(completion["lane_share"].get<double>(), 0.8) << completion.dump();
  for (const auto& row : completion["abandoned_rows"]) EXPECT_FALSE(row["why"].get<std::string>().empty());
}

}  // namespace
}  // namespace fleetmap
