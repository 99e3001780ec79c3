#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::testing {

/// What is exactly true of one robot of the generated fleet.
struct GeneratedRobot {
  std::string id;
  std::vector<Stamp> stamps;  ///< of its scans
  std::vector<Pose> T_enu_base;
};

struct GeneratedFleet {
  GeoPoint origin;
  std::vector<GeneratedRobot> robots;
};

/// LiDAR (VLP-16, 0.8 m above base_link), IMU, GPS (1.5 m of slow error) and wheel speed of two robots that
/// meet in a made-up yard, as one rosbag2 folder each: `out`/r1, `out`/r2; those in `without_gps` have no
/// fix. The same bytes every time.
Result<GeneratedFleet> write_generated_fleet(const std::filesystem::path& out,
                                             const std::set<std::string>& without_gps = {});

}  // namespace fleetmap::testing
