#pragma once

#include <cstdint>
#include <vector>

#include "fleetmap/odometry/lidar_model.hpp"
#include "support/synthetic_lidar.hpp"

namespace fleetmap::testing {

/// Waves of 45 and 31 m that cross, `height` m in all, and waves of 0.7 to 2.9 m of `rough` m.
GroundShape rolling_ground(double height, double rough = 0.0);

/// Straight on, a bend, a stop, turns on the spot both ways, a long bend back.
std::vector<DriveLeg> errands();

inline bool keep_all(const sensor::ScanPoint&) { return true; }

/// A drive of which little may be seen: what it errs by must be stated.
struct PoorDrive {
  SyntheticWorld world;
  std::vector<DriveLeg> legs = errands();
  double noise = 0.02;  ///< m, of each range
  odometry::LidarModel model = odometry::vlp16();
  bool (*keep)(const sensor::ScanPoint&) = keep_all;  ///< the part of each scan that is used
  double wheel_scale = 1.02;                          ///< wheels tell so much more than is driven
};

PoorDrive drive_in(SyntheticWorld world);
PoorDrive drive_on(GroundShape ground);

/// The uncertainty that LOAM states for a drive, and its true error.
struct StatedDrive {
  int scans = 0, refused = 0;
  int degenerate = 0;      ///< scans with degenerate directions
  std::uint64_t lost = 0;  ///< scans
  double error = 0.0;      ///< m, at the end
  double sigma = 0.0;      ///< m, 1 sigma, that is stated for it
  double nees = 0.0,
         worst_nees = 0.0;  ///< over 3 s, a dimension, mean and largest: 1 if errors are as stated
  bool warned = false;      ///< `fleetmap odometry` would end with exit code 1
};

StatedDrive state_drive(const PoorDrive& drive, bool gyro_and_wheels, std::uint64_t seed = 1);

}  // namespace fleetmap::testing
