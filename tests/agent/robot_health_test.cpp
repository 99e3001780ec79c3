#include "robot_health.hpp"

#include <gtest/gtest.h>

namespace fleetmap::agent {
namespace {

using messages::Health;
using namespace std::chrono_literals;

TEST(RobotHealth, ARobotThatSeesAndKnowsItsPlaceHasNoProblem) {
  EXPECT_EQ(health_of({.since_scan = 100ms, .located = true}), Health{});
}

TEST(RobotHealth, EachProblemIsABitOfItsOwn) {
  EXPECT_EQ(health_of({.since_scan = 6s, .located = true}).problems, Health::kNoScan);
  EXPECT_EQ(health_of({.unmatched_scans = 1, .located = true}).problems, Health::kScansNotMatched);
  EXPECT_EQ(health_of({.dropped_scans = 1, .located = true}).problems, Health::kScansDropped);
  EXPECT_EQ(health_of({.refused_writes = 1, .located = true}).problems, Health::kDiskRefuses);
  EXPECT_EQ(health_of({}).problems, Health::kNoPose);
  const HealthCounters all{.since_scan = 1h, .unmatched_scans = 2, .dropped_scans = 3, .refused_writes = 4};
  EXPECT_EQ(health_of(all).problems, Health::kAllProblems);
}

TEST(RobotHealth, TheClockThatIsOffMostIsNamed) {
  const Health health = health_of({.located = true, .behind = {{0.004, std::nullopt, -1.0, 0.5}}});
  EXPECT_EQ(static_cast<sensor::Source>(health.clock_sensor), sensor::Source::kGps);
  EXPECT_EQ(messages::seconds_behind(health.clock_offset), -1.024);
}

}  // namespace
}  // namespace fleetmap::agent
