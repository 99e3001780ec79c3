#pragma once

#include "fleetmap/localization/ekf.hpp"
#include "localization/synthetic_drive.hpp"

namespace fleetmap::localization::testing {

/// The position is on Earth, the covariance positive definite and the rotation of unit norm.
void expect_sound(const GlobalPose& G);

/// An EKF that has processed the sensors' samples of a drive.
Ekf run(const Sensors& sensors, const Drive& drive, double duration, const EkfConfig& config = {});

/// The horizontal error lies within `sigmas` of the covariance and below 6 m.
void expect_near_truth(const Ekf& ekf, const Drive& drive, double sigmas = 4.0);

}  // namespace fleetmap::localization::testing
