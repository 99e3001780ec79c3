#include <gmock/gmock.h>

#include "bag_samples.hpp"
#include "support/shared_data.hpp"

// The real drive, where it is installed.
namespace fleetmap::recording {
namespace {

using namespace recording::testing;

constexpr char kDriveName[] = "kitti_raw_2011_09_26_drive_0005";

TEST(KittiDrive, EveryFrameIsReadAndItsMarkDropped) {
  const auto drive = fleetmap::testing::shared_data(kDriveName);
  if (!drive) GTEST_SKIP() << kDriveName << " is not installed";
  auto reader = open(*drive);
  ASSERT_TRUE(reader) << reader.error().message;
  std::size_t points = 0, frame = 0;
  while (true) {
    auto sample = (*reader)->next();
    ASSERT_TRUE(sample) << sample.error().message;
    if (!*sample) break;
    const auto* scan = std::get_if<sensor::Scan>(&**sample);
    if (scan == nullptr) continue;
    EXPECT_EQ(to_ns(scan->stamp), static_cast<std::int64_t>(frame++) * 100'000'000);
    // The README counts the appended mark, of which each frame has one.
    EXPECT_GE(scan->points.size() + 1, 98'533u);
    EXPECT_LE(scan->points.size() + 1, 124'123u);
    EXPECT_FALSE(scan->points.back().position.isZero(0.0f));
    points += scan->points.size();
  }
  const Counters& counters = (*reader)->counters();
  EXPECT_EQ(counters.scans, 154u);
  EXPECT_EQ(counters.imus, 154u);
  EXPECT_EQ(counters.fixes, 154u);
  EXPECT_EQ(counters.wheels, 154u);
  EXPECT_EQ(counters.origin_points, 154u);
  EXPECT_NEAR(static_cast<double>(points) / 154.0, 121'733.0, 2.0);
}

TEST(KittiDrive, AHalfIsARobotOfItsOwn) {
  const auto drive = fleetmap::testing::shared_data(kDriveName);
  if (!drive) GTEST_SKIP() << kDriveName << " is not installed";
  ReaderConfig config;
  config.kitti.first_frame = 60;
  config.kitti.last_frame = 62;
  auto reader = open(*drive, config);
  ASSERT_TRUE(reader) << reader.error().message;
  const auto samples = read_all(**reader);
  ASSERT_EQ(samples.size(), 12u);
  EXPECT_EQ(to_ns(stamp_of(samples.front())), 6'000'000'000);
  // Karlsruhe, level, gravity up.
  const auto& imu = std::get<sensor::Imu>(samples.front());
  EXPECT_NEAR(imu.specific_force.z(), 9.8, 1.0);
}

}  // namespace
}  // namespace fleetmap::recording
