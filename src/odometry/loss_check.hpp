#pragma once

#include "fleetmap/odometry/loam_config.hpp"
#include "scan_matching.hpp"

namespace fleetmap::odometry {

/// Decides whether a scan was matched or the odometry is lost. The ground fits anywhere, and so do a few
/// posts and walls: a match also needs most of the upright features that the previous scans had, since they
/// cannot vanish within one scan.
class LossCheck {
 public:
  explicit LossCheck(const LoamConfig& config)
      : min_matches_(config.min_matches), min_inlier_fraction_(config.min_inlier_fraction) {}

  bool lost(const MatchResult& match);
  /// Forgets the previous scans.
  void restart() { usual_upright_ = 0.0; }

 private:
  bool misses_upright(const MatchResult& match);

  int min_matches_;
  double min_inlier_fraction_;
  double usual_upright_ = 0.0;  ///< smoothed MatchResult::upright_inliers of the previous scans
};

}  // namespace fleetmap::odometry
