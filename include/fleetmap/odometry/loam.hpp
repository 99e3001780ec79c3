#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/odometry/lidar_model.hpp"
#include "fleetmap/odometry/loam_config.hpp"
#include "fleetmap/odometry/loam_counters.hpp"
#include "fleetmap/odometry/local_map.hpp"
#include "fleetmap/sensor/samples.hpp"
#include "fleetmap/sensor/scan.hpp"

namespace fleetmap::odometry {

/// Result of one scan: pose, motion-compensated points and how well the scan was matched.
struct OdometryUpdate {
  Stamp stamp;  ///< Scan::stamp, wherever in the sweep it lies (LidarModel::stamp_phase for scans without
                ///< times)
  /// base_link at `stamp` in the odometry frame O, which is base_link at the first scan's stamp. Never jumps.
  Pose T_odom_base = Pose::Identity();
  /// Covariance that the motion since the previous update adds to the drift, right tangent [m, rad] of
  /// T_odom_base at `stamp`: T <- T exp(d). Sums of these, moved by adjoint(), are the drift over many scans
  /// (MotionCovariance).
  Matrix6d covariance = Matrix6d::Zero();
  /// Covariance of this pose in the local map, same tangent. It does not accumulate: a motion has that of its
  /// two ends.
  Matrix6d pose_noise = Matrix6d::Zero();
  Vector6d twist = Vector6d::Zero();  ///< of base_link in base_link, mean over the sweep, [m/s, rad/s]
  /// All valid returns within L_max in base_link at `stamp`, motion compensated, with intensity.
  cloud::PointCloud points;

  std::size_t edges = 0;         ///< edge features matched
  std::size_t planes = 0;        ///< plane features matched
  double inlier_fraction = 0.0;  ///< of the matched features
  double residual_rms = 0.0;     ///< m, of the inliers
  int iterations = 0;
  /// Directions of the pose [m, rad x mean range] that the scene did not constrain (columns, the first
  /// `degenerate_count`); there the pose follows the motion prior and the covariance is large.
  int degenerate_count = 0;
  Matrix6d degenerate_directions = Matrix6d::Zero();
  /// The scan did not fit the map; the pose is the prediction, and the covariance is that of the prediction.
  bool lost = false;
};

class LoamPipeline;

/// LiDAR odometry and mapping, scan to local map. After Zhang and Singh, LOAM (RSS 2014): edge and plane
/// features along each ring, motion compensation, Gauss-Newton on point-to-line and point-to-plane distances;
/// pose and velocity of each sweep are estimated together. Without rings every surface point is a plane
/// candidate. Not thread safe; one object per robot.
class Loam {
 public:
  /// A configuration that breaks a rule makes every add_scan() fail with that rule; validate() first.
  Loam(LoamConfig config, LidarModel model);
  ~Loam();
  Loam(Loam&&) noexcept;
  Loam& operator=(Loam&&) noexcept;

  /// Before the first sample of the IMU.
  void set_imu_rotation(const Eigen::Quaterniond& q_base_imu);
  /// Optional. Samples should reach past the end of a scan before that scan is added.
  void add_imu(const sensor::Imu& imu);
  void add_wheel(const sensor::Wheel& wheel);

  /// Fails, and changes nothing but the counters, on scans with too few usable points or going back in time,
  /// and on those that repeat the points of the scan before while the robot moves: a driver that hangs.
  Result<OdometryUpdate> add_scan(const sensor::Scan& scan);

  const LoamCounters& counters() const;
  /// Contradictions between the scans and the LiDAR's model, each reported once as a sentence for the log.
  std::vector<std::string> take_warnings();
  /// Size of the local map after the last scan.
  LocalMapSize map_size() const;

 private:
  std::unique_ptr<LoamPipeline> pipeline_;
};

}  // namespace fleetmap::odometry
