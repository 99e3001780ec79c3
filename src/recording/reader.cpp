#include "fleetmap/recording/reader.hpp"

#include <cmath>

#include "bag_reader.hpp"
#include "kitti_reader.hpp"

namespace fleetmap::recording {

Status ReaderConfig::validate() const {
  if (kitti.first_frame > kitti.last_frame)
    return failure("recording.kitti.first_frame must not be beyond last_frame");
  if (!(kitti.nominal_rate > 0.0) || !std::isfinite(kitti.nominal_rate)) {
    return failure("recording.kitti.nominal_rate must be a positive number of frames per second");
  }
  if (kitti.fix_degradation) {
    const FixDegradation& degradation = *kitti.fix_degradation;
    if (!(degradation.sigma > 0.0) || !std::isfinite(degradation.sigma)) {
      return failure("recording.kitti.fix_degradation.sigma must be a positive number of metres");
    }
    if (!(degradation.correlation_time > 0.0) || !std::isfinite(degradation.correlation_time)) {
      return failure("recording.kitti.fix_degradation.correlation_time must be a positive number of seconds");
    }
  }
  return {};
}

Result<std::unique_ptr<Reader>> open(const std::filesystem::path& path, const ReaderConfig& config) {
  if (auto status = config.validate(); !status) return tl::unexpected(status.error());
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return failure(path.string() + ": there is no such recording");
  if (looks_like_bag(path)) return open_bag(path, config.topics);
  if (looks_like_kitti(path)) return open_kitti(path, config.kitti);
  if (path.extension() == ".bag") {
    return failure(path.string() + ": ROS 1 bags are not read; convert it with `rosbags-convert --src " +
                   path.filename().string() + " --dst " + path.stem().string() + "`");
  }
  return failure(path.string() +
                 ": is neither a rosbag2 folder (metadata.yaml, .db3), nor a .db3 file, nor a KITTI folder "
                 "(velodyne_points and oxts, or velodyne and times.txt), nor a folder of .bin or .pcd scans");
}

}  // namespace fleetmap::recording
