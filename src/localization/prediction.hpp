#pragma once

#include "fleetmap/localization/filter.hpp"

namespace fleetmap::localization {

/// Integrates angular velocity and specific force (IMU frame) that hold on average over `dt` seconds; the
/// differences say how much they changed meanwhile, which bounds what sampling missed.
void predict_inertial(const EkfConfig& config, Filter& filter, double dt,
                      const Eigen::Vector3d& angular_velocity, const Eigen::Vector3d& specific_force,
                      const Eigen::Vector3d& rate_change, const Eigen::Vector3d& force_change);

/// Constant speed and turn rate along the ground for `dt` seconds, for when no IMU speaks.
void predict_by_motion_model(const EkfConfig& config, Filter& filter, double dt);

/// Fresh wheel sample at the filter's time, else null.
const sensor::Wheel* recent_wheel(const EkfConfig& config, const Filter& filter);

double yaw_of(const Eigen::Matrix3d& R);

}  // namespace fleetmap::localization
