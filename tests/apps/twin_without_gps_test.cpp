// A mission of robots without GPS, led by someone who knows where they are: they find each other by what
// places look like, from starts that nobody told them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "fleetmap/eval/trajectory.hpp"
#include "fleetmap/output/trajectory_file.hpp"
#include "fleetmap/store/store.hpp"
#include "small_twin.hpp"
#include "support/command_line.hpp"
#include "support/measured.hpp"
#include "support/process.hpp"

namespace fleetmap {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr const char* kLed = "robot: {guided: true, gps: {fitted: false}}";

nlohmann::json evaluation_of(const std::filesystem::path& out) {
  testing::Process evaluation({testing::kProgram, "eval", out.string(), "--no-pictures"});
  EXPECT_EQ(evaluation.wait(), 0) << evaluation.output();
  std::ifstream file(out / "evaluation.json");
  return nlohmann::json::parse(file, nullptr, false);
}

int ties_between_sessions(const std::filesystem::path& directory) {
  const auto store = store::Store::open_read_only(directory / "store.db");
  if (!store) return -1;
  int ties = 0;
  for (const auto& [id, alignment] : store->alignments()) {
    const graph::Node *i = store->node(alignment.i), *j = store->node(alignment.j);
    ties += i != nullptr && j != nullptr && i->session != j->session;
  }
  return ties;
}

TEST(TwinWithoutGps, RobotsThatKnowNoPlaceMakeOneMapThatLiesNowhere) {
  for (unsigned seed = 1; seed <= testing::seeds_to_run(1); ++seed) {
    const testing::SmallTwin twin;
    twin.write_fleet("", {kLed, kLed});
    const auto run =
        twin.run("out", {"--threads", "2", "--agents", "2", "--set", "world.seed=" + std::to_string(seed)});
    ASSERT_EQ(run.exit_code, 0) << run.output;
    const auto& r1 = run.report["agents"]["r1"];
    EXPECT_TRUE(run.report["completion"]["completed_s"].is_number()) << run.report["completion"].dump();
    EXPECT_THAT(r1["aligned_groups"], SizeIs(1)) << run.output;
    EXPECT_EQ(r1["not_georeferenced"], nlohmann::json({"r1", "r2"}));
    EXPECT_EQ(r1["map_hash"], run.report["agents"]["r2"]["map_hash"])
        << "submaps flow where robots are in reach";

    const auto evaluation = evaluation_of(run.out);
    ASSERT_TRUE(evaluation.is_object());
    EXPECT_GE(evaluation["alignments"]["used"].get<int>(), 1);
    EXPECT_EQ(evaluation["alignments"]["wrong_used"], 0);
    EXPECT_EQ(evaluation["fleet"]["wrong_merges"], 0);
    testing::expect_at_most(evaluation["fleet"]["ate_joint"], 0.0147, "without GPS, joint ATE in m", seed);
  }
}

TEST(TwinWithoutGps, TheFixOfOneRobotPutsAllOnTheMap) {
  for (unsigned seed = 1; seed <= testing::seeds_to_run(1); ++seed) {
    const testing::SmallTwin twin;
    twin.write_fleet("", {"", kLed});
    const auto run =
        twin.run("out", {"--threads", "2", "--agents", "2", "--set", "world.seed=" + std::to_string(seed)});
    ASSERT_EQ(run.exit_code, 0) << run.output;
    const auto& r2 = run.report["agents"]["r2"];
    EXPECT_THAT(r2["aligned_groups"], SizeIs(1)) << run.output;
    EXPECT_THAT(r2["not_georeferenced"], SizeIs(0));
    const auto truth = output::read_tum(run.out / "r2" / "truth.tum");
    const auto placed = output::read_tum(run.out / "r2" / "trajectory.tum");
    ASSERT_TRUE(truth && placed);
    const auto errors = eval::compare(*placed, *truth);
    ASSERT_TRUE(errors) << errors.error().message;
    // As far off as the GPS and the heading of the other one are.
    testing::expect_at_most(errors->ate_rmse, 5.0, "one with GPS, ATE of the other in m", seed);
    testing::expect_at_most(errors->ate_rmse_aligned, 0.0115, "one with GPS, ATE of the other, aligned, in m",
                            seed);
    // Each robot alone would not show where they lie to each other.
    const auto evaluation = evaluation_of(run.out);
    ASSERT_TRUE(evaluation.is_object());
    testing::expect_at_most(evaluation["fleet"]["ate_joint"], 0.0147, "one with GPS, joint ATE in m", seed);
  }
}

/// Its second start has an odometry frame that nothing but what it sees ties to the first.
TEST(TwinWithoutGps, ARobotThatWasRestartedGoesOnWithItsMap) {
  for (unsigned seed = 1; seed <= testing::seeds_to_run(1); ++seed) {
    const testing::SmallTwin twin;
    twin.write_fleet("",
                     {"robot: {guided: true, gps: {fitted: false}, switched_off: [{from: 20, until: 30}]}"});
    const auto run =
        twin.run("out", {"--threads", "2", "--agents", "1", "--set", "world.seed=" + std::to_string(seed)});
    ASSERT_EQ(run.exit_code, 0) << run.output;
    EXPECT_THAT(run.output, HasSubstr("session 1, going on from"));
    const auto evaluation = evaluation_of(run.out);
    ASSERT_TRUE(evaluation.is_object());
    EXPECT_GE(ties_between_sessions(run.out / "r1"), 1) << run.output;
    EXPECT_EQ(evaluation["alignments"]["wrong_used"], 0);
    testing::expect_at_most(evaluation["agents"]["r1"]["ate_rmse_aligned"], 0.0112,
                            "restarted, ATE aligned in m", seed);
  }
}

TEST(TwinWithoutGps, FleetWithoutGpsAndGuideIsRefused) {
  const testing::SmallTwin twin;
  twin.write_fleet("", {"", "robot: {gps: {fitted: false}}"});
  const auto run = twin.run("out", {"--agents", "2"});
  EXPECT_EQ(run.exit_code, 78);
  EXPECT_THAT(run.output, HasSubstr("guided: a robot whose gps is not fitted cannot tell where to drive"));
}

}  // namespace
}  // namespace fleetmap
