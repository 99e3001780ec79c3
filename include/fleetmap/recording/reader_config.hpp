#pragma once

#include <optional>
#include <string>

#include "fleetmap/core/result.hpp"
#include "fleetmap/recording/kitti_config.hpp"
#include "fleetmap/sensor/ouster_metadata.hpp"

namespace fleetmap::recording {

/// Topics of a bag ("/points"). Empty: the only topic of that type, or else the one with our own name.
/// "none": not read. The config keys are recording.topics.points and so on.
struct Topics {
  std::string points;  ///< sensor_msgs/msg/PointCloud2, CustomMsg of a Livox driver, or
                       ///< velodyne_msgs/msg/VelodyneScan; needed
  std::string imu;     ///< sensor_msgs/msg/Imu
  std::string fix;     ///< sensor_msgs/msg/NavSatFix
  std::string wheel;   ///< nav_msgs/msg/Odometry
};

/// Topics and formats of a recording.
struct ReaderConfig {
  Topics topics;
  KittiConfig kitti;
  /// Describes the Ouster LiDAR of a capture; if empty, the .json file beside it is read.
  std::optional<sensor::OusterMetadata> ouster_metadata{};
  bool scans_needed = true;  ///< refuse a bag without any
  Status validate() const;
};

}  // namespace fleetmap::recording
