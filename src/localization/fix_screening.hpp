#pragma once

#include "fleetmap/localization/filter.hpp"

namespace fleetmap::localization {

struct BelievedCovariance {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();  ///< m^2, ENU; eigenvalues within floor and ceiling
  bool replaced = false;                            ///< the reported one said nothing
};
/// Reported covariance as far as it can be believed.
BelievedCovariance believed_covariance(const Eigen::Matrix3d& reported, const GpsModel& model);

/// The receiver has a fix, on Earth, not at exactly 0, 0 (which receivers say when they know nothing).
bool is_usable(const sensor::Fix& fix);

/// Whether a robot can have come from one position to the other in `dt` seconds.
bool is_reachable(const GeoPoint& from, const GeoPoint& to, double dt, double sigma, const GpsModel& model);

/// Counts `fix` into the run of doubted fixes, or starts the run anew if it does not agree with the one
/// before.
void extend_run(FixRun& run, const sensor::Fix& fix, double sigma, const GpsModel& model);

}  // namespace fleetmap::localization
