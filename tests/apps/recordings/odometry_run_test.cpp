#include "recordings/odometry_run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "apps/made_robot.hpp"
#include "apps/recorded_samples.hpp"
#include "support/synthetic_lidar.hpp"

namespace fleetmap::apps {
namespace {

using recording::Sample;
using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr int kScans = 6;

/// A drive that turns; scans at their stamps, before what gyro and wheels measure during their sweeps.
std::vector<Sample> samples_by_stamp() {
  const testing::SyntheticDrive drive({{2.0, 1.0, 0.8}});
  const auto world = testing::yard_world();
  const odometry::LidarModel lidar = odometry::vlp16();
  std::vector<Sample> samples;
  for (int k = 0; k < kScans; ++k) {
    const double start = 0.5 + 0.1 * k;
    samples.emplace_back(testing::make_scan(
        world, [&](double t) { return drive.at(t); }, start, lidar));
    for (int step = 0; step < 10; ++step) {
      samples.emplace_back(drive.imu(start + 0.01 * step));
      if (step % 5 == 0) samples.emplace_back(drive.wheel(start + 0.01 * step));
    }
  }
  return samples;
}

/// The same as a driver sends them: each scan when its sweep has ended.
std::vector<Sample> samples_by_end() {
  std::vector<Sample> samples = samples_by_stamp();
  std::ranges::stable_sort(samples, {}, [](const Sample& sample) {
    const auto* scan = std::get_if<sensor::Scan>(&sample);
    return scan != nullptr ? sensor::end_of(*scan) : recording::stamp_of(sample);
  });
  return samples;
}

Result<OdometryRun> run_of(std::vector<Sample> samples, const std::string& failure = {}) {
  RecordedSamples recording(std::move(samples), failure);
  return run_odometry(recording, {}, made_robot_perception());
}

TEST(OdometryRun, AScanWaitsForWhatGyroAndWheelsMeasuredDuringItsSweep) {
  const auto sent = run_of(samples_by_end()), stamped = run_of(samples_by_stamp());
  ASSERT_TRUE(sent && stamped);
  ASSERT_THAT(sent->poses, SizeIs(kScans));
  ASSERT_THAT(stamped->poses, SizeIs(kScans));
  for (std::size_t k = 0; k < kScans; ++k) {
    EXPECT_EQ(sent->poses[k].stamp, stamped->poses[k].stamp);
    EXPECT_EQ(sent->poses[k].T_w_base.matrix(), stamped->poses[k].T_w_base.matrix()) << "scan " << k;
  }
  EXPECT_GT((sent->poses.back().T_w_base.translation() - sent->poses.front().T_w_base.translation()).norm(),
            0.2);
  EXPECT_THAT(sent->wall_ms, SizeIs(kScans));
}

TEST(OdometryRun, ASensorThatHasStoppedKeepsNoScanWaiting) {
  std::vector<Sample> samples = samples_by_stamp();
  std::size_t gyro = 0;
  std::erase_if(samples, [&](const Sample& sample) {
    return std::holds_alternative<sensor::Imu>(sample) && ++gyro > 5;
  });
  const auto run = run_of(std::move(samples));
  ASSERT_TRUE(run);
  EXPECT_THAT(run->poses, SizeIs(kScans));
}

TEST(OdometryRun, RefusedScansAreCountedWithTheFirstReason) {
  std::vector<Sample> samples = samples_by_end();
  for (Sample& sample : samples) {
    if (auto* scan = std::get_if<sensor::Scan>(&sample)) scan->points.resize(3);
  }
  const auto run = run_of(std::move(samples));
  ASSERT_TRUE(run);
  EXPECT_EQ(run->refused, static_cast<std::size_t>(kScans));
  EXPECT_THAT(run->poses, SizeIs(0));
  EXPECT_NE(run->first_refusal, "");
}

TEST(OdometryRun, ARecordingThatCannotBeReadToItsEndIsAnError) {
  const auto run = run_of(samples_by_end(), "bag.db3: disk image is malformed");
  ASSERT_FALSE(run);
  EXPECT_THAT(run.error().message, HasSubstr("disk image is malformed"));
}

TEST(OdometryRun, EachSampleIsShownAsItIsReadAndAsItIsUsed) {
  std::vector<Sample> samples = samples_by_end();
  sensor::Imu& lost = std::get<sensor::Imu>(*std::ranges::find_if(
      samples, [](const Sample& sample) { return std::holds_alternative<sensor::Imu>(sample); }));
  lost.angular_velocity.x() = std::numeric_limits<double>::quiet_NaN();
  RecordedSamples recording(samples);
  std::vector<std::size_t> kinds, used;
  ASSERT_TRUE(run_odometry(recording, {}, made_robot_perception(),
                           {[&](const Sample& sample) { kinds.push_back(sample.index()); },
                            [&](const Sample& sample) { used.push_back(sample.index()); }}));
  EXPECT_EQ(used.size() + 1, kinds.size()) << "the gyro's NaN is not used";
  std::vector<std::size_t> expected;
  for (const Sample& sample : samples) expected.push_back(sample.index());
  EXPECT_EQ(kinds, expected);
}

}  // namespace
}  // namespace fleetmap::apps
