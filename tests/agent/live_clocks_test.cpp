// Whole agents in virtual time, with one sensor of another clock: what the log names, what is used, and what
// becomes of the trajectory.
#include <gmock/gmock.h>

#include <cmath>
#include <iostream>

#include "agent/lapping_robot.hpp"
#include "bus/captured_log.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::agent {
namespace {

using fleetmap::testing::LappingRobot;
using fleetmap::testing::SensorClock;
using fleetmap::testing::TemporaryFolder;
using sensor::Source;

constexpr double kStartUp = 16.0;  // s: what is 2.5 s late may only be late for 10 s

/// A sensor's clock, and what is expected of the log and of the correction.
struct WrongClock {
  const char* name;
  SensorClock clock;
  double seconds;    ///< of the drive
  const char* said;  ///< a regular expression, after the sensor's name
  double error;      ///< s, of the corrected stamps
};
void PrintTo(const WrongClock& clock, std::ostream* out) { *out << clock.name; }

constexpr Duration kBoot = stamp_from_ns(7'000'000'000) - LappingRobot::kStart;
constexpr double kDrift = 700.0, kDrive = 60.0;  // s
/// s. A time scale's difference is corrected exactly, others to what drivers take.
constexpr double kExact = 1e-6, kDriver = 0.12, kDrifting = 0.04;
const WrongClock kWrongClocks[] = {
    {"gps_time",
     {std::chrono::seconds(18)},
     kDrive,
     "stamps are 18.00 s ahead of .*GPS time and UTC",
     kExact},
    {"tai", {std::chrono::seconds(37)}, kDrive, "stamps are 37.00 s ahead of .*TAI and UTC", kExact},
    {"hour", {std::chrono::hours(1)}, kDrive, "stamps are 3600.00 s ahead of .*time zone", kExact},
    {"boot_time", {kBoot}, kDrive, "stamps are 174999999[23].[0-9]+ s behind .*sensor's start", kDriver},
    {"few_seconds", {std::chrono::milliseconds(-2500)}, kDrive, "stamps are 2.[3-7][0-9] s behind", kDriver},
    {"fast", {{}, 100e-6}, kDrift, "clock runs (9[5-9]|10[0-5]) ppm too fast", kDrifting},
};

struct Rms {
  double odometry = 0.0, position = 0.0;  ///< m
  int scans = 0;
};

Rms rms_of(const LappingRobot& robot) {
  Rms rms;
  for (const LappingRobot::Error& error : robot.errors()) {
    if (error.seconds < kStartUp) continue;
    ++rms.scans;
    rms.odometry += error.odometry * error.odometry;
    rms.position += error.position * error.position;
  }
  rms.odometry = std::sqrt(rms.odometry / rms.scans);
  rms.position = std::sqrt(rms.position / rms.scans);
  return rms;
}

std::uint64_t used(const Agent& agent, Source source) {
  const localization::EkfCounters ekf = agent.perception().localization_counters();
  switch (source) {
    case Source::kLidar:
      return agent.perception().odometry_counters().updates;
    case Source::kImu:
      return ekf.imu_used;
    case Source::kGps:
      return ekf.fix_used;
    case Source::kWheel:
      return ekf.wheel_used;
  }
  return 0;
}

class LiveClocks : public ::testing::TestWithParam<std::tuple<WrongClock, std::size_t>> {
 protected:
  LappingRobot::Options options(const char* folder) const {
    LappingRobot::Options options;
    options.folder = folder_.path() / folder;
    if (std::get<0>(GetParam()).seconds == kDrift) options.scan_rate = 2.0;
    return options;
  }

  const TemporaryFolder folder_;
};

TEST_P(LiveClocks, AreNamedWithTheirOffsetAndUsed) {
  const auto& [clock, k] = GetParam();
  const auto source = static_cast<Source>(k);
  LappingRobot right(options("right"));
  right.run_for(clock.seconds);
  LappingRobot::Options with_wrong = options("wrong");
  with_wrong.clocks[k] = clock.clock;
  const bus::testing::CapturedLog log;
  LappingRobot wrong(with_wrong);
  wrong.run_for(clock.seconds);

  EXPECT_EQ(log.count(": stamps are") + log.count(": its clock runs"), 1) << log.text();
  EXPECT_THAT(log.text(),
              ::testing::ContainsRegex(std::string(sensor::to_string(source)) + ": .*" + clock.said));
  const sensor::ClockOffsets& offsets = wrong.agent().perception().clock_offsets();
  for (std::size_t other = 0; other < sensor::kSources; ++other) {
    const auto of = static_cast<Source>(other);
    if (other != k) {
      EXPECT_EQ(offsets.correction(of), Duration::zero()) << sensor::to_string(of);
    }
    // Until it is known which clock is wrong, the samples of none are used.
    const double unclear = (other == k ? 12.0 : 2.0) * right.published(of) / clock.seconds + 3.0;
    EXPECT_GE(static_cast<double>(used(wrong.agent(), of)) + unclear,
              static_cast<double>(used(right.agent(), of)))
        << sensor::to_string(of);
  }
  EXPECT_NEAR(to_seconds(offsets.correction(source)),
              -to_seconds(clock.clock.ahead) - clock.clock.rate_error * clock.seconds, clock.error);
  EXPECT_EQ(wrong.agent().perception().odometry_counters().clock_resets, 0u);
  EXPECT_EQ(wrong.agent().perception().localization_counters().restarts, 0u);
  const Rms with_right = rms_of(right), with = rms_of(wrong);
  ASSERT_GT(with.scans, 0.95 * with_right.scans);
  // A stamp that is off moves a pose by what the robot drives meanwhile, and all of O by how far the first
  // pose turns meanwhile, seen from up to 24 m away.
  constexpr double kSpeed = 1.7, kSwing = 4.0;  // m/s
  EXPECT_LT(with.odometry, std::hypot(1.2 * with_right.odometry, kSwing * clock.error));
  EXPECT_LT(with.position, std::hypot(1.08 * with_right.position, kSpeed * clock.error));
  std::cout << clock.name << " of " << sensor::to_string(source) << ": O " << with_right.odometry << " -> "
            << with.odometry << " m, G " << with_right.position << " -> " << with.position << " m\n";
}

std::string case_name(const ::testing::TestParamInfo<std::tuple<WrongClock, std::size_t>>& info) {
  const auto& [clock, k] = info.param;
  return std::string(clock.name) + "_of_" + sensor::to_string(static_cast<Source>(k));
}

INSTANTIATE_TEST_SUITE_P(Live, LiveClocks,
                         ::testing::Combine(::testing::ValuesIn(kWrongClocks),
                                            ::testing::Range<std::size_t>(0, sensor::kSources)),
                         case_name);

/// Its stamps are compared with when its scans come, and stay as they are: no other stamp contradicts them.
TEST(LiveClocksOfALidarAlone, AreNamedWithTheirOffsetAndUsed) {
  const TemporaryFolder folder;
  LappingRobot::Options options;
  options.folder = folder.path() / "r1";
  options.fitted = {true, false, false, false};
  options.clocks[0].ahead = std::chrono::seconds(18);
  const bus::testing::CapturedLog log;
  LappingRobot robot(options);
  robot.run_for(40.0);
  EXPECT_THAT(log.text(),
              ::testing::ContainsRegex("lidar: stamps are 18.00 s ahead of the computer's clock"));
  EXPECT_EQ(log.count("stamps are"), 1) << log.text();
  const auto& perception = robot.agent().perception();
  EXPECT_NEAR(perception.clock_offsets().behind(Source::kLidar).value(), -18.0, 0.2);
  EXPECT_GE(perception.odometry_counters().updates + 3,
            static_cast<std::uint64_t>(robot.published(Source::kLidar)));
  EXPECT_EQ(perception.odometry_counters().map_restarts, 0u);
  EXPECT_GT(robot.agent().store().nodes().size(), 5u);
}

}  // namespace
}  // namespace fleetmap::agent
