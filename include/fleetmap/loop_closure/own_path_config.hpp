#pragma once

#include <cstdint>

#include "fleetmap/core/result.hpp"

namespace fleetmap::loop_closure {

/// Selection of loop closures within a robot's own path.
struct OwnPathConfig {
  /// m between two nodes by odometry. Clouds 45 m apart still overlap in the middle, and a robot that drives
  /// every sixth row of a large site has no other constraint between its lanes.
  double reach = 45.0;
  /// m of path between them: odometry drifts too little over less. Twice the radius of spherized clouds at
  /// least, so that the two share no submap.
  double min_path = 90.0;
  double spacing = 20.0;  ///< m of path since the last candidate
  /// A node is used when so many more were made: its cloud is then complete.
  std::uint32_t min_nodes_after = 3;
  Status validate() const;
};

}  // namespace fleetmap::loop_closure
