#pragma once

#include <filesystem>
#include <utility>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/global_pose.hpp"
#include "fleetmap/output/line_file.hpp"

namespace fleetmap::output {

/// G over time as a CSV file that grows line by line:
/// stamp_s,latitude_deg,longitude_deg,altitude_m,qx,qy,qz,qw,sigma_e_m,sigma_n_m,sigma_u_m,sigma_yaw_deg
class GlobalTrackFile {
 public:
  static Result<GlobalTrackFile> append_to(const std::filesystem::path& file);
  /// As LineFile::add.
  Status add(const GlobalPose& G);

 private:
  explicit GlobalTrackFile(LineFile lines) : lines_(std::move(lines)) {}
  LineFile lines_;
};

/// Stamp, position and attitude of each line, with those of part_before(file); the covariance holds the four
/// sigmas only. A last line that is cut off (a killed writer) is left out; any other bad line is an error.
Result<std::vector<GlobalPose>> read_global_track(const std::filesystem::path& file);

}  // namespace fleetmap::output
