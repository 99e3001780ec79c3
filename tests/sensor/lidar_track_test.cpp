#include "lidar_track.hpp"

#include <gtest/gtest.h>

namespace fleetmap::sensor {
namespace {

/// 1 m/s and 0.5 rad/s to the left, 10 scans a second.
std::vector<LidarPose> track() {
  std::vector<LidarPose> all;
  for (int k = 0; k <= 20; ++k) {
    all.push_back({stamp_from_ns(0) + k * std::chrono::milliseconds(100),
                   make_pose(rotation_from_rpy(0.0, 0.0, 0.05 * k), Eigen::Vector3d(0.1 * k, 0.0, 0.0))});
  }
  return all;
}

TEST(LidarTrack, KnotsKeepTheirDistance) {
  const auto knots = lidar_knots(track(), 0.45);
  ASSERT_EQ(knots.size(), 5u);
  EXPECT_EQ(knots[1].stamp - knots[0].stamp, std::chrono::milliseconds(500));
  EXPECT_NEAR(turned(knots), 1.0, 1e-9);
}

TEST(LidarTrack, PosesAreInterpolatedWithinIt) {
  std::vector<LidarPose> all = track();
  const auto pose = pose_at(all, stamp_from_ns(250'000'000));
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->translation().x(), 0.25, 1e-9);
  EXPECT_NEAR(rpy_from_rotation(pose->linear()).z(), 0.125, 1e-9);
  EXPECT_FALSE(pose_at(all, stamp_from_ns(-1)));
  EXPECT_FALSE(pose_at(all, stamp_from_ns(2'100'000'000)));
  all.erase(all.begin() + 5, all.begin() + 12);
  EXPECT_FALSE(pose_at(all, stamp_from_ns(800'000'000))) << "a gap";
}

}  // namespace
}  // namespace fleetmap::sensor
