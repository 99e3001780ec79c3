#pragma once

#include <filesystem>
#include <utility>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/output/line_file.hpp"

namespace fleetmap::output {

/// A pose of base_link in the frame w of its trajectory (ENU or an odometry frame).
struct StampedPose {
  Stamp stamp;
  Pose T_w_base = Pose::Identity();
};
using Trajectory = std::vector<StampedPose>;

/// File that holds O of an agent's `index`-th session (Sessions::index_of): odometry.tum, then
/// odometry-1.tum, ...
std::filesystem::path odometry_file(const std::filesystem::path& directory, std::size_t index);

/// "stamp_s x y z qx qy qz qw" of base_link, as `evo` reads it.
std::string tum_line(const StampedPose& pose);

/// A TUM file with its part_before(); empty lines and those that begin with # are skipped. Fails with file
/// and line on anything else, on a number that is not finite, and where stamps go back.
Result<Trajectory> read_tum(const std::filesystem::path& file);
/// One that a program still writes, or was killed while it did: a last line that is cut off is left out.
/// Stamps are taken as they are.
Result<Trajectory> read_growing_tum(const std::filesystem::path& file);
Status write_tum(const std::filesystem::path& file, const Trajectory& trajectory);

/// A TUM file that grows line by line.
class TrajectoryFile {
 public:
  /// Replaces what is there.
  static Result<TrajectoryFile> create(const std::filesystem::path& file);
  /// odometry_file(directory, index), begun anew. One that a lost store has left is moved aside and not
  /// written over, since its nodes may come back from other robots.
  static Result<TrajectoryFile> begin_session(const std::filesystem::path& directory, std::size_t index);
  /// As LineFile::add.
  Status add(const StampedPose& pose) { return lines_.add(tum_line(pose)); }

 private:
  explicit TrajectoryFile(LineFile lines) : lines_(std::move(lines)) {}
  LineFile lines_;
};

}  // namespace fleetmap::output
