#include "ambiguity_search.hpp"

namespace fleetmap::odometry {
namespace {

constexpr int kSteps = 4;  // to each side
constexpr double kStep = kSearchRadius / kSteps;
constexpr double kInitialError = 1.5;  // m
constexpr double kSamePlace = 0.5;     // m

}  // namespace

bool is_ambiguous(const LoamConfig& config, ScanMatcher& matcher, const SelectedFeatures& features,
                  LocalMap& map, const SearchStart& start, const MatchResult& match) {
  Matrix12d wide = start.covariance;
  wide.topLeftCorner<3, 3>() += Eigen::Matrix3d::Identity();
  for (int forward = -kSteps; forward <= kSteps; ++forward) {
    for (int left = -kSteps; left <= kSteps; ++left) {
      MotionState before = start.state;
      before.T_odom_base = before.T_odom_base * Eigen::Translation3d(kStep * forward, kStep * left, 0.0);
      const MotionPrior there(config, before, wide, start.dt);
      const MatchResult other =
          matcher.align(features.match_planes, features.edges, map, there, there.predicted(), kInitialError);
      const double apart =
          (other.state.T_odom_base.translation() - match.state.T_odom_base.translation()).norm();
      const bool as_good = other.upright_inliers >= match.upright_inliers &&
                           other.upright_inliers * match.upright >= match.upright_inliers * other.upright;
      if (apart > kSamePlace && as_good) return true;
    }
  }
  return false;
}

}  // namespace fleetmap::odometry
