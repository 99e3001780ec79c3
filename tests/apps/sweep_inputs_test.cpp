#include "sweep_inputs.hpp"

#include <gtest/gtest.h>

#include <chrono>

namespace fleetmap::apps {
namespace {

using namespace std::chrono_literals;

Stamp at(Duration time) { return stamp_from_ns(1'700'000'000'000'000'000) + time; }

/// A scan whose sweep takes 100 ms.
sensor::Scan scan_at(Duration time) {
  return {at(time), true, false, {{{1.0f, 0.0f, 0.0f}, 0.0f, 0.0f, 0}, {{1.0f, 0.0f, 0.0f}, 0.0f, 0.1f, 0}}};
}
sensor::Imu imu_at(Duration time) {
  sensor::Imu imu;
  imu.stamp = at(time);
  return imu;
}
sensor::Wheel wheel_at(Duration time) { return {at(time), 1.0, 0.0}; }

TEST(SweepInputs, AScanWaitsUntilGyroAndWheelsHavePassedItsEnd) {
  SweepInputs inputs;
  inputs.add(imu_at(0ms));
  inputs.add(wheel_at(0ms));
  inputs.add(scan_at(0ms));
  EXPECT_FALSE(inputs.take_due());
  inputs.add(imu_at(101ms));
  EXPECT_FALSE(inputs.take_due()) << "the wheels are behind";
  inputs.add(wheel_at(101ms));
  const auto input = inputs.take_due();
  ASSERT_TRUE(input);
  EXPECT_EQ(input->scan.stamp, at(0ms));
  EXPECT_EQ(input->imu.size(), 2u);
  EXPECT_EQ(input->wheels.size(), 2u);
  EXPECT_FALSE(inputs.take_due());
}

TEST(SweepInputs, ASensorThatWasNeverHeardOrHasStoppedIsNotWaitedFor) {
  SweepInputs inputs;
  inputs.add(scan_at(0ms));
  EXPECT_TRUE(inputs.take_due());
  inputs.add(imu_at(0ms));
  for (const Duration time : {100ms, 200ms, 300ms}) inputs.add(scan_at(time));
  EXPECT_FALSE(inputs.take_due());
  inputs.add(scan_at(400ms));
  EXPECT_TRUE(inputs.take_due());
  EXPECT_FALSE(inputs.take_due());
  EXPECT_EQ(inputs.take()->scan.stamp, at(200ms)) << "the recording ends";
}

TEST(SweepInputs, TheOldestScanGivesWayAndIsCounted) {
  SweepInputs inputs(2);
  inputs.add(imu_at(0ms));
  for (const Duration time : {0ms, 100ms, 200ms}) inputs.add(scan_at(time));
  EXPECT_EQ(inputs.dropped(), 1u);
  EXPECT_EQ(inputs.take_due()->scan.stamp, at(100ms)) << "no place to wait in";
  EXPECT_FALSE(inputs.take_due());
}

TEST(SweepInputs, SamplesWithoutScansAreForgotten) {
  SweepInputs inputs;
  for (int k = 0; k < 100'000; ++k) inputs.add(imu_at(10ms * k));
  inputs.add(scan_at(0ms));
  const auto input = inputs.take_due();
  ASSERT_TRUE(input);
  EXPECT_LE(input->imu.size(), 4000u);
  EXPECT_EQ(input->imu.back().stamp, at(10ms * 99'999));
}

}  // namespace
}  // namespace fleetmap::apps
