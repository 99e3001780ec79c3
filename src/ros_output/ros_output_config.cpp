#include "fleetmap/ros_output/ros_output_config.hpp"

namespace fleetmap::ros_output {

Status RosOutputConfig::validate() const {
  if (!(map_voxel >= 0.02 && map_voxel <= 10.0)) return failure("ros.map_voxel: expected 0.02 to 10 m");
  if (map_points < 1000 || map_points > 1'000'000) return failure("ros.map_points: expected 1000 to 1000000");
  if (map_period < std::chrono::seconds(1)) return failure("ros.map_period: expected at least 1 s");
  return {};
}

}  // namespace fleetmap::ros_output
