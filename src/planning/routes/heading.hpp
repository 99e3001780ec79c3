#pragma once

#include <Eigen/Core>
#include <cmath>

namespace fleetmap::planning {

/// Direction of `d`, in rad from east, counter-clockwise.
inline double heading(const Eigen::Vector2d& d) { return std::atan2(d.y(), d.x()); }

}  // namespace fleetmap::planning
