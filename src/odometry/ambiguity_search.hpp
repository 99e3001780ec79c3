#pragma once

#include "feature_selection.hpp"
#include "fleetmap/odometry/loam_config.hpp"
#include "fleetmap/odometry/local_map.hpp"
#include "motion_prior.hpp"
#include "scan_matching.hpp"

namespace fleetmap::odometry {

/// Half the side of the searched square, m.
inline constexpr double kSearchRadius = 5.0;

/// The last pose with its covariance [d_pose, d_twist], `dt` s ago.
struct SearchStart {
  const MotionState& state;
  const Matrix12d& covariance;
  double dt;
};

/// After a loss: true if the scan fits as well at another place within kSearchRadius as at `match`. Rows look
/// alike, and a recording with a piece cut out continues some metres farther, so the match next to the
/// prediction may be one of several.
bool is_ambiguous(const LoamConfig& config, ScanMatcher& matcher, const SelectedFeatures& features,
                  LocalMap& map, const SearchStart& start, const MatchResult& match);

}  // namespace fleetmap::odometry
