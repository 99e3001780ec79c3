// Trials in network namespaces, with a script that stands for deploy/netns/field.sh and needs none.
#include "fleetmap/experiment/field_engine.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/file_content.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::experiment {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

class FieldEngineTest : public ::testing::Test {
 protected:
  FieldEngineTest() {
    one_.base = folder_.write("fleet.yaml",
                              "agents: [{id: r1, recording: {path: x}}, {id: r2, recording: {path: y}}]\n"
                              "field: {robot: agent.yaml, recordings: bags, radio: {kbit_s: 64}}\n");
    folder_.write("agent.yaml", "id: r1\n");
    folder_.write("bags/r1/x", "");
    one_.agents = 2;
    fs::create_directories(directory());
    // The evaluation of what the robots leave.
    folder_.write("left/field.json", R"({"all_know_s": 0.5, "equal": 1})");
    for (const char* robot : {"left/r1", "left/r2"}) {
      folder_.write(std::string(robot) + "/node_times.csv", "time_ns,node\n1000000000,r1#7/0\n");
      folder_.write(std::string(robot) + "/link_trace.csv",
                    "time_s,link,from,to,kbit_s,ms,loss_percent,used_kbit_s,messages\n");
      folder_.write(std::string(robot) + "/report.json", R"({"topics": []})");
    }
  }
  fs::path directory() const { return folder_.path() / "case"; }
  /// Runs the case with a script of these lines; "$out" is the folder of the case.
  Result<CaseResult> run(const std::string& lines) {
    const fs::path script =
        folder_.write("field.sh", "#!/bin/sh\nout=" + directory().string() + "\n" + lines + "\n");
    fs::permissions(script, fs::perms::owner_all);
    return FieldEngine(script, folder_.path(), stop_)(one_, directory());
  }
  std::string leave_files() const { return "cp -r " + (folder_.path() / "left").string() + "/. $out\n"; }
  std::string read(const std::string& name) const { return testing::file_text(directory() / name); }

  testing::TemporaryFolder folder_;
  Case one_;
  std::atomic<bool> stop_{false};
};

TEST_F(FieldEngineTest, TheScriptGetsTheFieldAndTheRobotsKeys) {
  one_.overrides = {{"nodes.spacing", "3"}, {"field.radio.loss", "20"}};
  const auto result = run("for a in \"$@\"; do echo \"$a\" >> $out/arguments; done\n" + leave_files());
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_EQ(result->metrics.at("field.all_know_s"), 0.5);
  EXPECT_EQ(result->metrics.at("field.equal"), 1.0);
  const std::string arguments = read("arguments");
  EXPECT_THAT(arguments, HasSubstr("--scenario\ntrial\n--agents\n2\n--recordings\n" +
                                   (folder_.path() / "bags").string() + "\n--out\n" + directory().string()));
  EXPECT_THAT(arguments, HasSubstr("--radio\n64\n"));
  EXPECT_THAT(arguments, HasSubstr("--loss\n20\n"));
  EXPECT_THAT(arguments, HasSubstr("--robot\n" + (folder_.path() / "agent.yaml").string() + "\n"));
  EXPECT_THAT(arguments, HasSubstr("--set\nnodes.spacing=3\n"));
  EXPECT_THAT(arguments, ::testing::Not(HasSubstr("field.radio"))) << "no robot has a field";
  EXPECT_THAT(arguments, HasSubstr("--program\n" + fs::read_symlink("/proc/self/exe").string() + "\n"));
}

TEST_F(FieldEngineTest, AFailureTellsTheLastWordsOfTheScript) {
  const auto failed = run("echo radio on fire; exit 3");
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().message,
            (folder_.path() / "field.sh").string() + " exited with 3:\nradio on fire");
  const auto skipped = run("echo first; echo no namespaces here; exit 77");
  ASSERT_FALSE(skipped);
  EXPECT_EQ(skipped.error().message, "no namespaces here") << "a machine that cannot do it says why";
}

TEST_F(FieldEngineTest, MissingResultsOfRobotsAreNamed) {
  const auto result = run("exit 0");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().message, "field.json was not written");
}

TEST_F(FieldEngineTest, NeedsTheSensorsOfItsRobotsAndAGoodFleet) {
  one_.overrides = {{"field.robot", "\"\""}};
  const auto without = run("exit 0");
  ASSERT_FALSE(without);
  EXPECT_THAT(without.error().message, HasSubstr("field.robot: expected the AGENT.yaml"));
  one_.overrides = {{"field.patience", "0"}};
  const auto bad = run("exit 0");
  ASSERT_FALSE(bad);
  EXPECT_THAT(bad.error().message, HasSubstr("--set field.patience: "));
  EXPECT_FALSE(fs::exists(directory() / "field.log")) << "nothing was started";
}

}  // namespace
}  // namespace fleetmap::experiment
