#include "fleetmap/sensor/scan.hpp"

#include <gtest/gtest.h>

namespace fleetmap::sensor {
namespace {

using std::chrono::milliseconds;

const Stamp kStamp = stamp_from_ns(5'000'000'000);

Scan scan_with_times(std::initializer_list<float> times) {
  Scan scan{kStamp, true, false, {}};
  for (const float time : times) scan.points.push_back({Eigen::Vector3f::Zero(), 0.0f, time, 0});
  return scan;
}

TEST(Scan, EndsWithItsLastPoint) {
  EXPECT_EQ(end_of(scan_with_times({0.0f, 0.0625f, 0.03125f})), kStamp + std::chrono::microseconds(62'500));
  EXPECT_EQ(end_of(scan_with_times({-0.0625f, -0.03125f})), kStamp) << "the stamp is of the last point";
}

TEST(Scan, SweepIsTheTimeBetweenFirstAndLastPoint) {
  EXPECT_EQ(sweep_of(scan_with_times({-0.0625f, 0.0f, 0.0625f})), milliseconds(125));
  EXPECT_EQ(sweep_of(scan_with_times({})), Duration::zero());
}

TEST(Scan, TimesThatTheDeviceDoesNotStateDoNotCount) {
  Scan scan = scan_with_times({0.0f, 0.0625f});
  scan.has_time = false;
  EXPECT_EQ(end_of(scan), kStamp);
  EXPECT_EQ(sweep_of(scan), Duration::zero());
}

}  // namespace
}  // namespace fleetmap::sensor
