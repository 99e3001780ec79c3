#pragma once

#include <filesystem>
#include <fstream>
#include <vector>

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

/// Grows line by line; each line is with the operating system before `add` returns.
class TrajectoryFile {
 public:
  /// Replaces what is there.
  static Result<TrajectoryFile> create(const std::filesystem::path& file);
  Status add(const StampedPose& pose);

 private:
  TrajectoryFile(std::filesystem::path path, std::ofstream out)
      : path_(std::move(path)), out_(std::move(out)) {}
  std::filesystem::path path_;
  std::ofstream out_;
};

}  // namespace fleetmap::agent
