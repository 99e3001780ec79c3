#include <gmock/gmock.h>

#include "support/command_line.hpp"

namespace fleetmap {
namespace {

using ::testing::HasSubstr;

using GridRun = testing::CommandLineTest;

TEST_F(GridRun, NamesTheCasesNearToAnUnknownOneAndMarksEqualRuns) {
  const std::string paper = std::string(FLEETMAP_SOURCE_DIR) + "/config/experiments/paper.yaml";
  run({"experiment", "-c", paper, "--out", path("out"), "--case", "fleet_size.agents=2.rate=10.seed=1"});
  EXPECT_EQ(exit_code_, 2);
  EXPECT_THAT(output_, HasSubstr("near it: fleet_size.agents=2.rate=10.seed=01"));
  run({"experiment", "-c", paper, "--out", path("out"), "--report"});
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(output_, HasSubstr("holds no cases"));
  run({"experiment", "-c", paper, "--out", path("out"), "--list"});
  EXPECT_EQ(exit_code_, 0);
  EXPECT_THAT(output_, HasSubstr("division.division=uniform.seed=01: same run as "
                                 "fleet_size.agents=3.rate=10.seed=01\n"));
}

}  // namespace
}  // namespace fleetmap
