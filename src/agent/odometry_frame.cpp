#include "fleetmap/agent/odometry_frame.hpp"

namespace fleetmap::agent {

bool OdometryFrame::admits(const odometry::LoamCounters& counters, const Begin& begin) const {
  if (counters.map_restarts > map_restarts_) return begin("odometry lost its way and began anew");
  if (counters.clock_resets > clock_resets_) return begin("the LiDAR's stamps jumped back");
  return true;
}

void OdometryFrame::begun(const odometry::LoamCounters& counters) {
  map_restarts_ = counters.map_restarts;
  clock_resets_ = counters.clock_resets;
}

}  // namespace fleetmap::agent
