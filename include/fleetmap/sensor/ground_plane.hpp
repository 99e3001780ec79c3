#pragma once

#include <Eigen/Core>
#include <optional>

#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/sensor/scan.hpp"

namespace fleetmap::sensor {

/// The plane that most of a scan's points within some metres lie on and none of them under: the ground. Its
/// upward unit normal in base_link; empty where no such plane is seen. Planes that lean by more than 45
/// degrees are walls. The same scan gives the same plane.
std::optional<Eigen::Vector3d> ground_normal(const Scan& scan, const Pose& T_base_lidar);

}  // namespace fleetmap::sensor
