#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include "fleetmap/agent/perception.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/output/global_track.hpp"
#include "fleetmap/output/trajectory_file.hpp"

namespace fleetmap::agent {

/// Writes O, one file a session, and G of each scan into the agent's directory. A disk that fails later is
/// logged; the agent goes on.
class TrackRecorder {
 public:
  /// `index` of the session, as of store::Sessions::index_of().
  static Result<TrackRecorder> open(const std::filesystem::path& directory, std::size_t index);

  void add(const ScanEstimate& estimate);
  /// The following poses are of another odometry frame and go into another file.
  void begin_session(std::size_t index);

 private:
  TrackRecorder(std::filesystem::path directory, output::TrajectoryFile odometry,
                output::GlobalTrackFile global);

  std::filesystem::path directory_;
  std::optional<output::TrajectoryFile> odometry_;  ///< none if the session's file could not be opened
  output::GlobalTrackFile global_;
};

}  // namespace fleetmap::agent
