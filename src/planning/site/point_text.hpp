#pragma once

#include <Eigen/Core>
#include <string>

namespace fleetmap::planning {

/// "(12.3, -4.5)", in metres, for errors.
std::string point_text(const Eigen::Vector2d& p);

}  // namespace fleetmap::planning
