#include "recordings/odometry_summary.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

namespace fleetmap::apps {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

OdometryRun run_of_ten_scans() {
  OdometryRun run;
  for (int k = 0; k < 10; ++k) {
    run.wall_ms.push_back(k + 1.0);
    run.poses.push_back({stamp_from_ns(1'000'000'000LL + 100'000'000LL * k), Pose::Identity()});
  }
  run.cpu_s = 0.03;
  run.counters.updates = 10;
  return run;
}

std::string losses_of(const OdometryRun& run) {
  std::ostringstream out;
  print_losses(out, run);
  return out.str();
}

TEST(OdometrySummary, GivesTimesAScan) {
  OdometryRun run = run_of_ten_scans();
  std::ostringstream out;
  print_summary(out, run);
  EXPECT_THAT(out.str(), HasSubstr("scans 10  mean 5.50 ms"));
  EXPECT_THAT(out.str(), HasSubstr("max 10.00 ms  CPU 3.00 ms/scan"));
  EXPECT_THAT(out.str(), Not(HasSubstr("refused")));
  run.refused = 2;
  run.first_refusal = "no points";
  print_summary(out, run);
  EXPECT_THAT(out.str(), HasSubstr("refused 2 scans, first: no points\n"));
}

TEST(OdometrySummary, SoundRunPrintsItsLengthAlone) {
  const std::string text = losses_of(run_of_ten_scans());
  EXPECT_THAT(text, HasSubstr("length 0 m"));
  EXPECT_EQ(std::ranges::count(text, '\n'), 1);
}

TEST(OdometrySummary, EachLossIsSaidWithItsCount) {
  OdometryRun run = run_of_ten_scans();
  run.counters.lost = 3;
  run.first_lost = run.poses[4].stamp;
  EXPECT_THAT(losses_of(run), HasSubstr("lost 3 of 10 scans, the first 0.4 s after the start"));
  run.counters.map_restarts = 2;
  EXPECT_THAT(losses_of(run), HasSubstr("begun anew 2 times"));
  EXPECT_FALSE(run.kept_its_way());
  run.counters.refused_repeated = 7;
  EXPECT_THAT(losses_of(run), HasSubstr("7 scans have the very points of the scan before"));
  run.blind = 5;
  EXPECT_THAT(losses_of(run), HasSubstr("5 of 10 scans show the motion in some directions only"));
  run.counters.map_overflows = 1;
  EXPECT_THAT(losses_of(run), HasSubstr("the local map was full 1 times"));
}

}  // namespace
}  // namespace fleetmap::apps
