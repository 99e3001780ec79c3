#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::registration::testing {

/// A made-up place: walls, boxes and poles at random on gently rolling ground, the same for the same seed.
class MadeWorld {
 public:
  explicit MadeWorld(unsigned seed, double half_extent_m = 70.0);

  /// Two endless parallel walls and the ground between them: nothing tells where along x one is.
  static MadeWorld corridor();

  /// `count` points within `radius_m` of the sensor, in its frame, each with Gaussian noise.
  cloud::PointCloud scan(const Pose& T_world_sensor, std::size_t count, double noise_m, unsigned seed,
                         double radius_m = 40.0) const;

 private:
  struct Surface {
    Eigen::Vector3d corner, a, b;
  };
  MadeWorld() = default;
  void add(const Eigen::Vector3d& corner, const Eigen::Vector3d& a, const Eigen::Vector3d& b);
  void add_box(const Eigen::Vector3d& corner, const Eigen::Vector3d& size, double angle);
  std::vector<Surface> surfaces_;
  bool with_ground_ = true;
  double half_extent_ = 70.0;
};

inline Pose level_pose(double x, double y, double z, double yaw) {
  return make_pose(rotation_from_rpy(0, 0, yaw), Eigen::Vector3d(x, y, z));
}

struct ScanPair {
  cloud::PointCloud target;
  cloud::PointCloud source;
  Pose T_target_source;
};

/// Two scans of one place, `apart_m` and `yaw` apart, each with its own noise, the source a little tilted.
ScanPair scan_pair(const MadeWorld& world, double apart_m, double yaw, unsigned seed,
                   std::size_t count = 15'000);

struct PoseError {
  double translation_m;
  double rotation_rad;
};

PoseError error_between(const Pose& truth, const Pose& estimate);

inline constexpr double kDegree = M_PI / 180.0;

}  // namespace fleetmap::registration::testing
