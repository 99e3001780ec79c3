#pragma once

#include <cstddef>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"

namespace fleetmap::ros_output {

/// Output for the tools of ROS 2, beside the odometry.
struct RosOutputConfig {
  bool publish = true;
  bool tf = true;          ///< /tf and /tf_static; false where another program owns these frames
  double map_voxel = 0.2;  ///< m, edge of the voxels by which submaps and map are thinned
  std::size_t map_points =
      200'000;  ///< of the whole map at most: the voxels grow until it fits. 1e6 take 20 MB
  Duration map_period = std::chrono::seconds(10);  ///< between two messages of the whole map

  Status validate() const;
};

}  // namespace fleetmap::ros_output
