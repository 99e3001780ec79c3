#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fleetmap/core/result.hpp"

namespace fleetmap::odometry {

/// Source of the ring of a point when the scan has no ring field.
enum class RingSource {
  kElevation,   ///< nearest vertical angle of the table (points in firing order or in any order)
  kPointOrder,  ///< points come ring by ring from the topmost one, each a full turn (KITTI files)
  kNone,        ///< no rings: non-repeating patterns
};

inline constexpr std::size_t kMaxRings = 256;

/// Model of a LiDAR. Azimuth is atan2(y, x) in the LiDAR frame (x forward, z up).
struct LidarModel {
  std::string name;
  /// Elevation of each ring, rad, index = ring number. Empty: a device without rings.
  std::vector<double> vertical_angles;
  RingSource ring_source = RingSource::kElevation;
  double scan_period = 0.1;  ///< s, duration of one revolution (or frame)
  int columns = 1800;        ///< firings of each ring in one revolution, nominal
  /// Seen from above. Only used when a scan has no times.
  bool clockwise = true;
  /// Azimuth, rad, at which a revolution starts; empty: at the first point. Only used when a scan has no
  /// times.
  std::optional<double> sweep_start_azimuth;
  /// Position of Scan::stamp within the revolution, 0 = its start, 1 = its end. Only used if a scan has no
  /// times.
  double stamp_phase = 0.0;

  bool has_rings() const { return !vertical_angles.empty(); }
  /// Fails with the field's name and the rule that it breaks.
  Status validate() const;
};

/// Velodyne VLP-16: 16 rings from -15 to 15 deg, ring 0 lowest.
LidarModel vlp16();
/// Ouster OS1-64 (33 deg of view): 64 rings from 16.6 to -16.6 deg, ring 0 topmost.
LidarModel os1_64();
/// Velodyne HDL-64E as KITTI stores it: ring by ring from the top, the stamp (camera trigger) facing forward,
/// half a revolution after its start at the rear.
LidarModel hdl64e();
/// Any LiDAR: rings are used if the scans name them, and motion is compensated if the points have times.
LidarModel generic_lidar();

/// By the name used in configurations: vlp16, os1-64, hdl64e, generic. Fails with the names that exist.
Result<LidarModel> lidar_model(std::string_view name);

}  // namespace fleetmap::odometry
