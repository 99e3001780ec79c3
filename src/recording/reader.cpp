#include "fleetmap/recording/reader.hpp"

#include <cmath>

#include "bag_reader.hpp"
#include "fleetmap/core/paths.hpp"
#include "kitti_reader.hpp"
#include "pcap_reader.hpp"

namespace fleetmap::recording {

const sensor::SensorFrames& Reader::frames() const {
  static const sensor::SensorFrames kNone;
  return kNone;
}

const std::vector<std::string>& Reader::findings() const {
  static const std::vector<std::string> kNone;
  return kNone;
}

Result<std::unique_ptr<Reader>> open(const std::filesystem::path& path, const ReaderConfig& config,
                                     ScanContent content) {
  if (auto status = config.validate(); !status) return tl::unexpected(status.error());
  if (!is_there(path)) return failure(path.string() + ": there is no such recording");
  if (is_bag(path)) return open_bag(path, config, content);
  if (is_capture(path)) return open_capture(path, config.ouster_metadata, content);
  if (has_kitti_layout(path)) return open_kitti(path, config.kitti, content);
  return failure(path.string() +
                 ": is neither a rosbag2 folder (metadata.yaml, .db3 or .mcap), nor such a file or a ROS 1 "
                 ".bag, nor a capture (.pcap), nor a KITTI folder "
                 "(velodyne_points and oxts, or velodyne and times.txt), nor a folder of .bin or .pcd scans");
}

}  // namespace fleetmap::recording
