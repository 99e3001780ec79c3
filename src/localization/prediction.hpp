#pragma once

#include "fleetmap/localization/filter.hpp"

namespace fleetmap::localization {

/// Integrates angular velocity and specific force (IMU frame), averages over `dt` seconds. Their change over
/// the interval bounds the sampling error.
void predict_inertial(const EkfConfig& config, Filter& filter, double dt,
                      const Eigen::Vector3d& angular_velocity, const Eigen::Vector3d& specific_force,
                      const Eigen::Vector3d& rate_change, const Eigen::Vector3d& force_change);

/// Predicts with constant speed and turn rate along the ground for `dt` seconds, where no IMU sample is
/// available.
void predict_by_motion_model(const EkfConfig& config, Filter& filter, double dt);

/// Fresh wheel sample at the filter's time, else null.
const sensor::Wheel* recent_wheel(const EkfConfig& config, const Filter& filter);

double yaw_of(const Eigen::Matrix3d& R);

}  // namespace fleetmap::localization
