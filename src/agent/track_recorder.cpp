#include "fleetmap/agent/track_recorder.hpp"

#include <spdlog/spdlog.h>

#include <utility>

namespace fleetmap::agent {

Result<TrackRecorder> TrackRecorder::open(const std::filesystem::path& directory, std::size_t index) {
  Result<output::TrajectoryFile> odometry = output::TrajectoryFile::begin_session(directory, index);
  if (!odometry) return tl::unexpected(odometry.error());
  Result<output::GlobalTrackFile> global = output::GlobalTrackFile::append_to(directory / "global_track.csv");
  if (!global) return tl::unexpected(global.error());
  return TrackRecorder(directory, std::move(*odometry), std::move(*global));
}

TrackRecorder::TrackRecorder(std::filesystem::path directory, output::TrajectoryFile odometry,
                             output::GlobalTrackFile global)
    : directory_(std::move(directory)), odometry_(std::move(odometry)), global_(std::move(global)) {}

void TrackRecorder::add(const ScanEstimate& estimate) {
  const odometry::OdometryUpdate& update = estimate.odometry;
  if (odometry_) {
    if (const Status written = odometry_->add({update.stamp, update.T_odom_base}); !written)
      spdlog::error("{}", written.error().message);
  }
  if (estimate.G) {
    if (const Status written = global_.add(*estimate.G); !written)
      spdlog::error("{}", written.error().message);
  }
}

void TrackRecorder::begin_session(std::size_t index) {
  Result<output::TrajectoryFile> file = output::TrajectoryFile::begin_session(directory_, index);
  odometry_.reset();
  if (file) {
    odometry_.emplace(std::move(*file));
  } else {
    spdlog::error("{}", file.error().message);
  }
}

}  // namespace fleetmap::agent
