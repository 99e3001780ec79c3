#include "fleetmap/recording/reader_config.hpp"

#include <cmath>

namespace fleetmap::recording {

Status ReaderConfig::validate() const {
  if (kitti.first_frame > kitti.last_frame)
    return failure("recording.kitti.first_frame must not be beyond last_frame");
  if (!(kitti.nominal_rate > 0.0) || !std::isfinite(kitti.nominal_rate)) {
    return failure("recording.frame_rate must be a positive number of frames per second");
  }
  if (kitti.fix_degradation) {
    const FixDegradation& degradation = *kitti.fix_degradation;
    if (!(degradation.sigma > 0.0) || !std::isfinite(degradation.sigma)) {
      return failure("recording.gps_error.sigma must be a positive number of metres");
    }
    if (!(degradation.correlation_time > 0.0) || !std::isfinite(degradation.correlation_time)) {
      return failure("recording.gps_error.correlation_time must be a positive number of seconds");
    }
  }
  return {};
}

}  // namespace fleetmap::recording
