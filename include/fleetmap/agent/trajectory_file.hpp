#pragma once

#include <filesystem>
#include <utility>
#include <vector>

#include "fleetmap/agent/line_file.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::agent {

struct StampedPose {
  Stamp stamp;
  Pose T_w_base = Pose::Identity();
};

/// Where the `index`-th session of an agent keeps O (Sessions::index_of): odometry.tum, then odometry-1.tum,
/// ...
std::filesystem::path odometry_file(const std::filesystem::path& directory, std::size_t index);

/// "stamp_s x y z qx qy qz qw" of base_link, as `evo` reads it.
std::string tum_line(const StampedPose& pose);

/// Reads a TUM file; a line that is cut off (a killed writer) ends it. Fails with file and line on anything
/// else.
Result<std::vector<StampedPose>> read_trajectory(const std::filesystem::path& file);
Status write_trajectory(const std::filesystem::path& file, const std::vector<StampedPose>& poses);

class TrajectoryFile {
 public:
  /// Replaces what is there.
  static Result<TrajectoryFile> create(const std::filesystem::path& file);
  /// As LineFile::add.
  Status add(const StampedPose& pose) { return lines_.add(tum_line(pose)); }

 private:
  explicit TrajectoryFile(LineFile lines) : lines_(std::move(lines)) {}
  LineFile lines_;
};

}  // namespace fleetmap::agent
