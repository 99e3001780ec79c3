#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fleetmap/sim/lidar.hpp"
#include "fleetmap/sim/robot_twin.hpp"
#include "fleetmap/sim/scene.hpp"
#include "sim/lane_drive.hpp"

namespace fleetmap::testing {

/// Inputs that an odometry uses of a drive.
struct OdometryUse {
  const char* name;
  bool deskew = true;
  bool gyro = false;
};

struct LaneOdometry {
  double ate = 0.0;     ///< m, RMSE of the aligned trajectory
  double drift = 0.0;   ///< mean share of 20 m
  double cpu_ms = 0.0;  ///< a scan
  std::uint64_t scans = 0, lost = 0, map_restarts = 0;
};

/// One odometry for each of `uses` over one drive; all see the same scans. The LiDAR stands on a mast 0.6 m
/// above base_link, the IMU below it on the chassis.
std::vector<LaneOdometry> odometry_of_lanes(const sim::World& world, const sim::Scene& scene,
                                            const sim::LidarSpec& lidar, const DriveCondition& how,
                                            double length, std::uint64_t seed,
                                            std::span<const OdometryUse> uses);

/// The pose of the LiDAR during the scan `number` of a drive.
sim::ScanJob scan_of(const LaneDrive& drive, const sim::LidarSpec& lidar, std::uint64_t number,
                     std::uint64_t seed);
/// Mounting of the LiDAR on its mast.
Pose T_base_mast();

}  // namespace fleetmap::testing
