#pragma once

#include "fleetmap/localization/filter.hpp"

namespace fleetmap::localization {

/// Forward speed, no sideways and no vertical speed, and yaw rate where measured.
void update_from_wheel(const EkfConfig& config, Filter& filter, const sensor::Wheel& wheel);

/// No sideways and no vertical speed, for robots without wheel odometry.
void update_nonholonomic(const EkfConfig& config, Filter& filter);

/// Levels the attitude by gravity while the velocity is not yet estimated.
void update_from_gravity(const EkfConfig& config, Filter& filter, const sensor::Imu& imu, double dt);

/// Position of the antenna with covariance R (ENU, m^2); false if it lies beyond the gate and nothing was
/// changed.
bool update_from_position(const EkfConfig& config, Filter& filter, const Eigen::Vector3d& p_enu_antenna,
                          const Eigen::Matrix3d& R);

/// Forgets the heading.
void lose_heading(const EkfConfig& config, Filter& filter);

}  // namespace fleetmap::localization
