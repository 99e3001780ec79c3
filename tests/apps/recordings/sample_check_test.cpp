#include "recordings/sample_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <variant>

#include "apps/made_robot.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Samples of all four sensors for a minute; those of the GPS are `gps_ahead`.
struct CheckedSamples {
  std::size_t admitted_fixes = 0;
  Stamp last_fix;
  std::vector<std::string> news;
};
CheckedSamples checked_samples(Duration gps_ahead, double force_unit, bool uses_gps = true) {
  agent::PerceptionConfig config;
  config.uses_gps = uses_gps;
  SampleCheck check({}, config);
  CheckedSamples run;
  const auto add = [&](recording::Sample sample, Stamp now) {
    const bool admitted = check.admit(sample, now);
    std::ranges::move(check.take_warnings(), std::back_inserter(run.news));
    if (const auto* fix = std::get_if<sensor::Fix>(&sample); fix && admitted) {
      ++run.admitted_fixes;
      run.last_fix = fix->stamp;
    }
  };
  for (int k = 0; k < 6000; ++k) {
    const Stamp now = kStart + std::chrono::milliseconds(10 * k);
    sensor::Imu imu;
    imu.stamp = now;
    imu.specific_force = {0.0, 0.0, 9.81 / force_unit};
    add(imu, now);
    if (k % 2 == 0) add(sensor::Wheel{now, 1.0, 0.0}, now);
    if (k % 10 == 0) add(sensor::Scan{now, false, false, {}}, now);
    if (k % 20 == 0) add(sensor::Fix{now + gps_ahead, {0.7, 0.1, 600.0}}, now);
  }
  return run;
}

TEST(SampleCheck, SoundSamplesAreAdmitted) {
  const CheckedSamples sound = checked_samples(Duration::zero(), 1.0);
  EXPECT_THAT(sound.news, IsEmpty());
  EXPECT_EQ(sound.admitted_fixes, 300u);
}

TEST(SampleCheck, FindsWhatIsWrongWithClocksAndValues) {
  const CheckedSamples odd = checked_samples(std::chrono::seconds(18), 9.80665);
  EXPECT_THAT(odd.news, Contains(HasSubstr("its unit is g ")));
  EXPECT_THAT(odd.news, Contains(HasSubstr("18")));
  EXPECT_GT(odd.admitted_fixes, 200u);
  EXPECT_NEAR(to_seconds(odd.last_fix - kStart), 59.8, 0.3) << "corrected";
}

TEST(SampleCheck, FixesThatAreNotUsedAreNotChecked) {
  const CheckedSamples without = checked_samples(std::chrono::seconds(18), 1.0, false);
  EXPECT_THAT(without.news, IsEmpty());
  EXPECT_EQ(without.admitted_fixes, 0u);
}

}  // namespace
}  // namespace fleetmap::apps
