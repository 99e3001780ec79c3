#pragma once

namespace fleetmap::planning {

struct RolloutConfig {
  double length = 0.0;            ///< m, rolled out
  double touch = 0.0;             ///< m, clearance below which the robot touches something
  double wanted_clearance = 0.0;  ///< m, where there is room
  double last_curvature = 0.0;    ///< 1/m, of the arc driven now: changing it has a price
};

}  // namespace fleetmap::planning
