// `fleetmap run`: its options, and all that a run of the twin leaves.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "apps/small_twin.hpp"
#include "fleetmap/monitor/preview_writer.hpp"
#include "fleetmap/output/trajectory_file.hpp"
#include "support/command_line.hpp"

namespace fleetmap {
namespace {

using ::testing::HasSubstr;

using FleetRun = testing::CommandLineTest;

TEST_F(FleetRun, TakesAFileOrRecordingsAndNotBoth) {
  for (const std::vector<std::string>& input :
       {std::vector<std::string>{}, {"-c", "f.yaml", "--recording", "r1=d"}}) {
    std::vector<std::string> arguments{"run", "--out", path("out")};
    arguments.insert(arguments.end(), input.begin(), input.end());
    run(arguments);
    EXPECT_EQ(exit_code_, 2);
    EXPECT_THAT(output_, HasSubstr("give either -c FLEET.yaml or --recording NAME=PATH"));
  }
}

TEST_F(FleetRun, ARecordingHasANameAndAPath) {
  const std::string form = "expected NAME=PATH, e.g. r1=drive1";
  for (const auto& [text, reason] : {std::pair<std::string, std::string>("a long drive", form),
                                     {"r1=", form},
                                     {"=drive1", "agent id '' must be 1 to 8 characters"},
                                     {"a long name=drive1", "agent id 'a long name' must be"}}) {
    expect_usage_error({"run", "--recording", text, "--out", path("out")},
                       "--recording " + text + ": " + reason);
    EXPECT_EQ(output_.find(form) == std::string::npos, reason != form) << output_;
    EXPECT_EQ(output_.find("agent id") == std::string::npos, reason == form) << output_;
  }
  EXPECT_FALSE(std::filesystem::exists(path("out"))) << "nothing was begun";
}

TEST_F(FleetRun, FilesThatAreMissingAreNamed) {
  run({"run", "-c", path("none.yaml"), "--out", path("out")});
  EXPECT_EQ(exit_code_, 78);
  EXPECT_THAT(output_, HasSubstr("none.yaml: no such file"));
  run({"run", "--recording", "r1=" + path("nothing"), "--out", path("out")});
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(output_, HasSubstr(path("nothing")));
}

TEST_F(FleetRun, NoMoreAgentsThanTheFileHas) {
  run({"run", "-c", FLEETMAP_SOURCE_DIR "/config/fleets/farm_small.yaml", "--agents", "6", "--out",
       path("out")});
  EXPECT_EQ(exit_code_, 2);
  EXPECT_THAT(output_, HasSubstr("farm_small.yaml has only 5 agents; give at most so many"));
}

TEST(FleetRunOfTheTwin, LeavesTheTruthTheSiteAndTheReportOfTheAgentsThatAreKept) {
  const testing::SmallTwin twin;
  const auto run = twin.run("out", {"--agents", "2", "--set", "max_time=10", "--threads", "2"});
  EXPECT_TRUE(run.exit_code == 0 || run.exit_code == 1) << run.output;
  ASSERT_TRUE(run.report.is_object()) << run.output;
  EXPECT_EQ(run.report["agents"].size(), 2u);
  for (const char* file : {"truth.ply", "site.geojson", "report.html", "r1/store.db", "r2/ekf.tum"})
    EXPECT_TRUE(std::filesystem::exists(run.out / file)) << file;
  EXPECT_FALSE(std::filesystem::exists(run.out / "r3"));
  const auto truth = output::read_tum(run.out / "r1/truth.tum");
  ASSERT_TRUE(truth) << truth.error().message;
  ASSERT_GT(truth->size(), 10u);
  EXPECT_NEAR(to_seconds(truth->back().stamp - truth->front().stamp), 10.0, 1.0);
  EXPECT_THAT(run.output, HasSubstr("s of virtual time in "));
  // The page of `fleetmap monitor`, which was not open, has nothing to decode.
  const auto store = store::Store::open_read_only(run.out / "r1/store.db");
  ASSERT_TRUE(store) << store.error().message;
  EXPECT_FALSE(store->nodes().empty());
  monitor::PreviewWriter previews(run.out / "monitor.previews");
  for (const auto& [id, node] : store->nodes())
    EXPECT_EQ(previews.keep(node.submap_hash), store->has_submap(id)) << to_string(id);
}

}  // namespace
}  // namespace fleetmap
