#include <gmock/gmock.h>

#include <filesystem>

#include "support/command_line.hpp"

namespace fleetmap {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

using TwinGrid = testing::CommandLineTest;

TEST_F(TwinGrid, EachCaseIsRunAndEvaluatedByProcessesOfItsOwnAndOnlyOnce) {
  folder_.write("experiment.yaml",
                "title: Two seeds\nbase: " FLEETMAP_SOURCE_DIR
                "/config/fleets/farm_small.yaml\nseed_keys: [network.seed]\n"
                "metrics: [{name: agents.r1.path_length, title: Path}]\n"
                "studies:\n  - {name: short, title: Short, seeds: 2, metrics: [agents.r1.path_length], "
                "agents: 1, set: [max_time=1]}\n");
  const std::vector<std::string> command{"experiment", "-c", path("experiment.yaml"), "--out", path("cases"),
                                         "--jobs",     "2"};
  run(command);
  EXPECT_EQ(exit_code_, 0) << output_;
  std::size_t logs = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(path("cases"))) {
    const std::string name = entry.path().filename().string();
    logs += name == "run.log" || name == "eval.log" ? 1u : 0u;
  }
  EXPECT_EQ(logs, 4u);
  EXPECT_THAT(output_, HasSubstr("short.seed=01: done in "));
  EXPECT_THAT(output_, HasSubstr("short.seed=02: done in "));
  run(command);
  EXPECT_EQ(exit_code_, 0) << output_;
  EXPECT_THAT(output_, Not(HasSubstr("done in ")));
}

}  // namespace
}  // namespace fleetmap
