#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::testing {

/// The truth of one robot of the generated fleet.
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

/// The same of one robot, r1, that turns to and fro for 42 s, so that stamps can be compared all the time.
Result<GeneratedFleet> write_winding_drive(const std::filesystem::path& out);

/// Errors of the alignments of two robots' nodes that `store` holds, the worst of each: m
/// along the axes of the first node, and rad. None when it holds none.
struct AlignmentErrors {
  int count = 0;
  double translation = 0.0, rotation = 0.0;
};
AlignmentErrors errors_of_alignments(const store::Store& store, const GeneratedFleet& fleet);

}  // namespace fleetmap::testing
