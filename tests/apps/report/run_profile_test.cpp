#include "report/run_profile.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace fleetmap::apps {
namespace {

using ::testing::HasSubstr;

RunProfile hundred_seconds() {
  RunProfile profile;
  profile.feed = {.rays = 10.0, .driving = 5.0};
  profile.work = {.odometry = 20.0, .registration = 15.0, .spherization = 4.0, .placement = 6.0};
  profile.results = 8.0;
  profile.set_up = 2.0;
  profile.cpu = 100.0;
  profile.wall = 50.0;
  profile.virtual_time = 200.0;
  return profile;
}

TEST(RunProfile, TheRestIsWhatHasNoEntry) {
  RunProfile profile = hundred_seconds();
  EXPECT_DOUBLE_EQ(profile.rest(), 30.0);
  profile.cpu = 60.0;
  EXPECT_EQ(profile.rest(), 0.0) << "clocks differ by some milliseconds";
}

TEST(RunProfile, SharesAddUpToOne) {
  const nlohmann::json json = to_json(hundred_seconds());
  double sum = 0.0;
  for (const auto& [name, share] : json["shares"].items()) {
    EXPECT_DOUBLE_EQ(share.get<double>(), json[name + "_s"].get<double>() / 100.0) << name;
    sum += share.get<double>();
  }
  EXPECT_NEAR(sum, 1.0, 1e-12);
  EXPECT_EQ(json["shares"].size(), 9u);
  EXPECT_EQ(json["times_real_time"], 4.0);
}

TEST(RunProfile, IsThatOfTheOutcome) {
  FleetOutcome outcome;
  outcome.feed_seconds.rays = 3.0;
  outcome.work_seconds.placement = 4.0;
  outcome.results_seconds = 5.0;
  outcome.virtual_time = std::chrono::seconds(60);
  const RunProfile profile = profile_of(outcome, 1.5, 20.0, 12.0);
  EXPECT_EQ(profile.feed.rays, 3.0);
  EXPECT_EQ(profile.work.placement, 4.0);
  EXPECT_EQ(profile.results, 5.0);
  EXPECT_EQ(profile.set_up, 1.5) << "CPU before the first event";
  EXPECT_EQ(profile.cpu, 20.0);
  EXPECT_EQ(profile.wall, 12.0);
  EXPECT_EQ(profile.virtual_time, 60.0);
}

TEST(RunProfile, IsPrintedForAPerson) {
  EXPECT_THAT(summary_of(hundred_seconds()), HasSubstr("200 s of virtual time in 50 s, 4.0 times real time"));
  EXPECT_THAT(summary_of(hundred_seconds()), HasSubstr("rays 10 %, odometry 20 %"));
  EXPECT_THAT(summary_of({}), HasSubstr("0.0 times real time")) << "no division by zero";
}

}  // namespace
}  // namespace fleetmap::apps
