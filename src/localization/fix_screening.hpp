#pragma once

#include "fleetmap/localization/filter.hpp"

namespace fleetmap::localization {

struct BoundedCovariance {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();  ///< m^2, ENU; eigenvalues within floor and ceiling
  bool replaced = false;                            ///< the reported covariance was unusable
};
/// Reported covariance, bounded to plausible values.
BoundedCovariance bounded_covariance(const Eigen::Matrix3d& reported, const GpsModel& model);

/// Whether the receiver has a fix, on Earth, and not at exactly 0, 0 (which some receivers report without a
/// fix).
bool is_usable(const sensor::Fix& fix);

/// Whether a robot can have driven from one position to the other in `dt` seconds.
bool is_reachable(const GeoPoint& from, const GeoPoint& to, double dt, double sigma, const GpsModel& model);

/// Adds `fix` to the run of rejected fixes, or starts a new run if it does not agree with the previous one.
void extend_run(FixRun& run, const sensor::Fix& fix, double sigma, const GpsModel& model);

}  // namespace fleetmap::localization
