#pragma once

#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::loop_closure {

inline const AgentId kA = AgentId::parse("a").value();
inline const AgentId kB = AgentId::parse("b").value();
inline const Stamp kStart = stamp_from_ns(1'000'000'000);

/// On level ground.
inline Pose pose(double x, double y, double yaw) {
  return make_pose(rotation_from_rpy(0, 0, yaw), {x, y, 0.0});
}

}  // namespace fleetmap::loop_closure
