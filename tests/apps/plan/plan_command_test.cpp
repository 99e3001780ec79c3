#include <gmock/gmock.h>

#include "support/command_line.hpp"

namespace fleetmap {
namespace {

using ::testing::HasSubstr;

using PlanCommand = testing::CommandLineTest;

TEST_F(PlanCommand, RefusesWhatItCannotTake) {
  expect_usage_error({"plan"}, "site is required");
  expect_usage_error({"plan", "s.geojson", "--agents", "0"},
                     "--agents: must be a whole number from 1 to 100");
  expect_usage_error({"plan", "s.geojson", "--out", ""}, "--out: is empty; give a path");
}

/// README, "On a robot": the plan comes before the origin.
TEST_F(PlanCommand, PlansWithTheShippedAgentsFileAndNamesTheOriginThatItLacks) {
  const std::string root = FLEETMAP_SOURCE_DIR;
  run({"plan", root + "/config/sites/farm_200.geojson", "-c", root + "/config/agents/r1.yaml", "--out",
       path("plan.geojson")});
  EXPECT_EQ(exit_code_, 0) << output_;
  EXPECT_THAT(output_, HasSubstr("r1.yaml has no site.origin"));
  EXPECT_THAT(output_, HasSubstr("r2: "));
}

}  // namespace
}  // namespace fleetmap
