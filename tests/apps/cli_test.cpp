// Mistakes on the command line: exit codes that scripts rely on, and a message that names the remedy.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/command_line.hpp"
#include "support/file_content.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap {
namespace {

using ::testing::HasSubstr;

using CommandLine = testing::CommandLineTest;

TEST_F(CommandLine, UsageErrorsExitWith2) {
  run({});
  EXPECT_EQ(exit_code_, 2);
  run({"fly"});
  EXPECT_EQ(exit_code_, 2);
  run({"run", "--out", path("out")});
  EXPECT_EQ(exit_code_, 2);
  EXPECT_THAT(output_, HasSubstr("give either -c FLEET.yaml or --recording NAME=PATH"));
  run({"replay", "--rate", "0", "x"});
  EXPECT_EQ(exit_code_, 2);
}

/// README, "On a robot": the plan comes before the origin.
TEST_F(CommandLine, PlansWithTheShippedAgentsFileAndNamesTheOriginThatItLacks) {
  const std::string root = FLEETMAP_SOURCE_DIR;
  run({"plan", root + "/config/sites/farm_200.geojson", "-c", root + "/config/agents/r1.yaml", "--out",
       path("plan.geojson")});
  EXPECT_EQ(exit_code_, 0) << output_;
  EXPECT_THAT(output_, HasSubstr("r1.yaml has no site.origin"));
  EXPECT_THAT(output_, HasSubstr("r2: "));
}

TEST_F(CommandLine, NumbersOutOfRangeExitWith2) {
  struct Case {
    std::vector<std::string> arguments;
    std::string says;
  };
  for (const Case& wrong : std::initializer_list<Case>{
           {{"run", "-c", "f", "--out", path("out"), "--agents", "0"},
            "--agents: must be a whole number of at least 1"},
           {{"run", "-c", "f", "--out", path("out"), "--agents", "-1"},
            "--agents: must be a whole number of at least 1"},
           {{"run", "-c", "f", "--out", path("out"), "--threads", "-1"},
            "--threads: must be a whole number from 1 to 256"},
           {{"world", "w", "--seed", "-1"}, "--seed: must be a whole number of at least 0, is -1"},
           {{"world", "w", "--seed", "010"}, "--seed: must be a whole number"},
           {{"world", "w", "--density", "0"}, "--density: must be a number greater than 0, is 0\n"},
           {{"world", "w", "--density", "nan"}, "--density: must be a number greater than 0"},
           {{"sim", "-c", "f", "--duration", "-1"}, "--duration: must be a number of at least 0, is -1\n"},
           {{"agent", "-c", "f", "--exit-after-idle", "-3"},
            "--exit-after-idle: must be a number of at least 0"}}) {
    run(wrong.arguments);
    EXPECT_EQ(exit_code_, 2) << wrong.says;
    EXPECT_THAT(output_, HasSubstr(wrong.says));
  }
}

TEST_F(CommandLine, AnEmptyOutIsRefusedBeforeAnythingRuns) {
  for (const std::vector<std::string>& command :
       std::initializer_list<std::vector<std::string>>{{"run", "-c", "f"},
                                                       {"sim", "-c", "f"},
                                                       {"agent", "-c", "f", "--as", "r1"},
                                                       {"world", "w"},
                                                       {"odometry", "bag"},
                                                       {"map", "export", "store.db"},
                                                       {"map", "picture", "store.db"},
                                                       {"experiment", "-c", "e"}}) {
    std::vector<std::string> arguments = command;
    arguments.insert(arguments.end(), {"--out", ""});
    run(arguments);
    EXPECT_EQ(exit_code_, 2) << command.front();
    EXPECT_THAT(output_, HasSubstr("--out: is empty; give a path")) << command.front();
  }
}

TEST_F(CommandLine, ExperimentNamesTheCasesNearToAnUnknownOneAndMarksEqualRuns) {
  const std::string paper = std::string(FLEETMAP_SOURCE_DIR) + "/config/experiments/paper.yaml";
  run({"experiment", "-c", paper, "--out", path("out"), "--case", "fleet_size.agents=2.rate=10.seed=1"});
  EXPECT_EQ(exit_code_, 2);
  EXPECT_THAT(output_, HasSubstr("near it: fleet_size.agents=2.rate=10.seed=01"));
  run({"experiment", "-c", paper, "--out", path("out"), "--case", ""});
  EXPECT_EQ(exit_code_, 2);
  run({"experiment", "-c", paper, "--out", path("out"), "--list", "--report"});
  EXPECT_EQ(exit_code_, 2);
  run({"experiment", "-c", paper, "--out", path("out"), "--report"});
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(output_, HasSubstr("holds no cases"));
  run({"experiment", "-c", paper, "--out", path("out"), "--list"});
  EXPECT_EQ(exit_code_, 0);
  EXPECT_THAT(output_, HasSubstr("division.division=uniform.seed=01: same run as "
                                 "fleet_size.agents=3.rate=10.seed=01\n"));
}

TEST_F(CommandLine, AgentTakesOutOnlyWithAs) {
  run({"agent", "-c", "r1.yaml", "--out", path("out")});
  EXPECT_EQ(exit_code_, 2);
  EXPECT_THAT(output_, HasSubstr("--as"));
}

TEST_F(CommandLine, OutThatCannotBeWrittenStopsTheTwinAtOnce) {
  folder_.write("file", "no folder");
  run({"sim", "-c", std::string(FLEETMAP_SOURCE_DIR) + "/config/fleets/demo.yaml", "--out",
       path("file/out")});
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(output_, HasSubstr("file/out: cannot be made"));
}

TEST_F(CommandLine, HelpExitsWith0AndNamesEveryCommand) {
  run({"--help"});
  EXPECT_EQ(exit_code_, 0);
  for (const char* command :
       {"run", "agent", "replay", "odometry", "register", "check-config", "map", "eval"}) {
    EXPECT_THAT(output_, HasSubstr(command));
  }
}

TEST_F(CommandLine, BadConfigurationExitsWith78AndNamesFileAndLine) {
  folder_.write("bad.yaml", "id: r1\nfleet: [r1]\ndirectory: out\nlidar: {modle: vlp16}\n");
  for (const std::string command : {"check-config", "agent"}) {
    run(command == "agent" ? std::vector<std::string>{command, "-c", path("bad.yaml")}
                           : std::vector<std::string>{command, path("bad.yaml")});
    EXPECT_EQ(exit_code_, 78) << command;
    EXPECT_THAT(output_, HasSubstr("bad.yaml:4: lidar.modle: unknown key; did you mean 'model'?"));
  }
  run({"run", "-c", path("none.yaml"), "--out", path("out")});
  EXPECT_EQ(exit_code_, 78);
  run({"run", "--recording", "Robot=x", "--out", path("out")});
  EXPECT_EQ(exit_code_, 78);
}

TEST_F(CommandLine, ShippedConfigurationsAreValid) {
  for (const char* file :
       {"/config/agents/r1.yaml", "/config/robots/jackal_vlp16.yaml", "/config/fleets/kitti_0005.yaml"}) {
    run({"check-config", std::string(FLEETMAP_SOURCE_DIR) + file});
    EXPECT_EQ(exit_code_, 0) << output_;
  }
}

TEST_F(CommandLine, MissingRecordingIsAnErrorThatNamesIt) {
  run({"run", "--recording", "r1=" + path("nothing"), "--out", path("out")});
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(output_, HasSubstr(path("nothing")));
  run({"odometry", path("nothing"), "--out", path("o.tum")});
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(output_, HasSubstr(path("nothing")));
}

TEST_F(CommandLine, MissingProfilesStopAnAgentBeforeItDrives) {
  folder_.write("r1.yaml", "id: r1\nfleet: [r1]\ndirectory: out\ndds: {qos: no_such_folder}\n");
  run({"agent", "-c", path("r1.yaml")});
  EXPECT_EQ(exit_code_, 78);
  EXPECT_THAT(output_, HasSubstr("no_such_folder"));
}

TEST_F(CommandLine, StoreThatIsNoneIsRefused) {
  folder_.write("store.db", "this is no database, only text that is long enough to look at");
  run({"map", "info", path("store.db")});
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(output_, HasSubstr("store.db: is no store; give the store.db of a robot\n"));
  run({"map", "info", path(".")});
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(output_, HasSubstr("is a folder; give the store.db of a robot in it"));
  run({"map", "export", path("none.db"), "--out", path("map.ply")});
  EXPECT_EQ(exit_code_, 1);
}

TEST_F(CommandLine, RegisterTakesThePapersMethodWhichHasNoPrior) {
  std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 2500\nproperty float x\nproperty float y\nproperty float "
      "z\nend_header\n";
  for (int k = 0; k < 2500; ++k) {
    const int column = k % 50, row = k / 50;
    const double x = 0.6 * column, y = 0.6 * row;
    ply += std::to_string(x) + " " + std::to_string(y) + " " +
           std::to_string(2.0 * std::sin(0.4 * x) * std::cos(0.3 * y) + 0.05 * x) + "\n";
  }
  folder_.write("hills.ply", ply);
  run({"register", "--set", "registration.method=paper", path("hills.ply"), path("hills.ply")});
  EXPECT_EQ(exit_code_, 0);
  EXPECT_THAT(output_, HasSubstr("\"method\": \"paper\""));
  EXPECT_THAT(output_, HasSubstr("\"verdict\": \"accepted\""));
  run({"register", "--set", "registration.method=paper", "--prior", "0,0,0,0", path("hills.ply"),
       path("hills.ply")});
  EXPECT_THAT(output_, HasSubstr("--prior is not used"));
  run({"register", "--set", "registration.method=fpfh", path("hills.ply"), path("hills.ply")});
  EXPECT_EQ(exit_code_, 78);
  EXPECT_THAT(output_, HasSubstr("expected 'paper' or 'correlation', found 'fpfh'"));
}

TEST_F(CommandLine, RegisterPrintsAVerdictForUnusableClouds) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
      "z\nend_header\n";
  folder_.write("a.ply", header + "0 0 0\n1 0 0\n0 1 0\n");
  run({"register", path("a.ply"), path("a.ply")});
  EXPECT_EQ(exit_code_, 0) << output_;
  EXPECT_THAT(output_, HasSubstr("\"verdict\": \"rejected\""));
  EXPECT_THAT(output_, HasSubstr("\"reason\""));
  folder_.write("empty.ply",
                "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float "
                "z\nend_header\n");
  run({"register", path("empty.ply"), path("empty.ply")});
  EXPECT_EQ(exit_code_, 1) << output_;
  EXPECT_THAT(output_, HasSubstr("empty.ply: "));
  run({"register", path("a.ply"), path("b.ply")});
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(output_, HasSubstr("b.ply"));
}

TEST_F(CommandLine, EvalSaysWhatItMeasuredAndWhatIsMissing) {
  run({"eval", path("none")});
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(output_, HasSubstr("none: cannot be read"));
  std::filesystem::create_directories(path("empty"));
  run({"eval", path("empty")});
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(output_, HasSubstr("give the --out of fleetmap run"));

  std::string track;
  for (int k = 0; k < 40; ++k) track += std::to_string(k) + " " + std::to_string(k) + " 0 0 0 0 0 1\n";
  folder_.write("run/r1/trajectory.tum", track);
  folder_.write("run/r1/truth.tum", track);
  folder_.write("run/r2/trajectory.tum", "0 0 0 nan 0 0 0 1\n");
  std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 400\nproperty float x\nproperty float y\nproperty float "
      "z\nend_header\n";
  for (int k = 0; k < 400; ++k) ply += std::to_string(k % 20) + " " + std::to_string(k / 20) + " 0\n";
  folder_.write("run/r1/map.ply", ply);
  folder_.write("run/report.json",
                R"({"links": [{"agent": "r1", "link": "long_range", "wire_bytes": 800}]})");
  run({"eval", path("run")});
  EXPECT_EQ(exit_code_, 0);
  EXPECT_THAT(output_, HasSubstr("r1: ATE 0 m"));
  EXPECT_THAT(output_, HasSubstr("trajectory.tum:1: expected"));
  EXPECT_THAT(output_, HasSubstr("no true surface"));
  for (const char* file : {"evaluation.json", "evaluation.html", "map_top.png", "map_density.png"})
    EXPECT_TRUE(std::filesystem::exists(path("run") + "/" + file)) << file;
  const std::string content = testing::file_text(path("run/report.json"));
  EXPECT_THAT(content, HasSubstr("\"evaluation\""));
  EXPECT_THAT(content, HasSubstr("\"long_range_bytes_per_m2\": 2.0"));

  run({"eval", path("run"), "--truth", path("run/r1/map.ply")});
  EXPECT_EQ(exit_code_, 0);
  EXPECT_THAT(output_, HasSubstr("fitness 1"));
  EXPECT_TRUE(std::filesystem::exists(path("run/map_error.png")));
  run({"eval", path("run"), "--truth", path("none.ply")});
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(output_, HasSubstr("none.ply"));
  run({"eval", path("run"), "--truth-trajectories", path("none")});
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(output_, HasSubstr("none: no such folder"));
}

TEST_F(CommandLine, EvalOfARunThatWasCutOffTellsHowToSaveItsMap) {
  folder_.write("run/r1/odometry.tum", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n");
  folder_.write("run/r1/store.db", "");
  run({"eval", path("run")});
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(output_, HasSubstr("r1: the run was cut off"));
  EXPECT_THAT(output_, HasSubstr("fleetmap map export " + path("run/r1/store.db")));
  EXPECT_THAT(output_, HasSubstr("nothing could be measured"));
}

TEST_F(CommandLine, ATrialIsReadAndListedWithoutRunningIt) {
  const std::string trial = FLEETMAP_SOURCE_DIR "/config/trials/links.yaml";
  run({"trial", trial, "--out", path("out"), "--list"});
  EXPECT_EQ(exit_code_, 0) << output_;
  EXPECT_THAT(output_, HasSubstr("--set field.radio.kbit_s=50"));
  run({"trial", trial, "--out", path("out"), "--list", "--traces", path("none.csv")});
  EXPECT_EQ(exit_code_, 2) << output_;
  run({"trial", trial, "--out", path("out"), "--list", "--field", path("none.sh")});
  EXPECT_EQ(exit_code_, 2) << output_;
  EXPECT_THAT(output_, HasSubstr("none.sh: does not exist"));
  run({"trial", trial, "--out", path("out"), "--set", "field.radio.loss=120"});
  EXPECT_EQ(exit_code_, 78) << output_;
  EXPECT_THAT(output_, HasSubstr("loss must be in [0, 100] %"));
  run({"trial", trial, "--out", path("out"), "--set", "field.qos=nowhere"});
  EXPECT_EQ(exit_code_, 78) << output_;
  EXPECT_THAT(output_, HasSubstr("nowhere does not exist"));
}

}  // namespace
}  // namespace fleetmap
