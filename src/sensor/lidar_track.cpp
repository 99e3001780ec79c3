#include "lidar_track.hpp"

#include <algorithm>
#include <iterator>

namespace fleetmap::sensor {
namespace {

constexpr Duration kMaxScanGap = std::chrono::milliseconds(500);

}  // namespace

std::vector<LidarPose> lidar_knots(const std::vector<LidarPose>& track, double spacing) {
  std::vector<LidarPose> knots;
  for (const LidarPose& pose : track) {
    if (knots.empty() || to_seconds(pose.stamp - knots.back().stamp) > spacing) knots.push_back(pose);
  }
  return knots;
}

double turned(const std::vector<LidarPose>& track) {
  double sum = 0.0;
  for (std::size_t k = 1; k < track.size(); ++k)
    sum += so3_log(track[k - 1].T_odom_base.linear().transpose() * track[k].T_odom_base.linear()).norm();
  return sum;
}

std::optional<Pose> pose_at(const std::vector<LidarPose>& track, Stamp stamp) {
  const auto after = std::ranges::upper_bound(track, stamp, {}, &LidarPose::stamp);
  if (after == track.begin() || after == track.end()) return std::nullopt;
  const LidarPose& before = *std::prev(after);
  if (after->stamp - before.stamp > kMaxScanGap) return std::nullopt;
  const double share = to_seconds(stamp - before.stamp) / to_seconds(after->stamp - before.stamp);
  return interpolate(before.T_odom_base, after->T_odom_base, share);
}

}  // namespace fleetmap::sensor
