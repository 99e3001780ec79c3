#pragma once

#include <Eigen/Core>
#include <optional>

#include "fleetmap/core/result.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::output {

/// Stores where the robot's LiDAR is, in base_link (m): what it saw through depends on it.
Status keep_lidar_mount(store::Store& store, const Eigen::Vector3d& p_base_lidar);
/// Empty for a store that an older program wrote.
std::optional<Eigen::Vector3d> lidar_mount(const store::Store& store);

}  // namespace fleetmap::output
