#include "ambiguity_search.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace fleetmap::odometry {
namespace {

/// Points of walls across the way at these x, and of two walls along it every `step` m.
std::vector<Eigen::Vector3d> corridor(const std::vector<double>& walls, double from, double to, double step) {
  std::vector<Eigen::Vector3d> points;
  for (double z = 0.05; z < 2.0; z += 0.1) {
    for (const double x : walls) {
      for (double y = -1.95; y < 2.0; y += 0.1) points.emplace_back(x, y, z);
    }
    for (double x = from; x < to; x += step) {
      points.emplace_back(x, -3.0, z);
      points.emplace_back(x, 3.0, z);
    }
  }
  return points;
}

/// Whether a scan that shows two walls 2.5 m apart is ambiguous in a map of these walls.
bool ambiguous_among(const std::vector<double>& walls) {
  const LoamConfig config;
  LocalMap map(config);
  map.add_surfaces(corridor(walls, -15.0, 20.0, 0.1), {0.0, 0.0, 1.0});
  SelectedFeatures scan;
  for (const Eigen::Vector3d& p : corridor({2.5, 5.0}, 0.0, 6.0, 1.0)) {
    if (scan.match_planes.empty() || (scan.match_planes.back().position - p.cast<float>()).norm() > 0.25f)
      scan.match_planes.push_back({p.cast<float>()});
  }
  ScanMatcher matcher(config);
  const MotionState state;
  const Matrix12d covariance = 1e-2 * Matrix12d::Identity();
  const MotionPrior prior(config, state, covariance, 0.1);
  MatchResult match = matcher.align(scan.match_planes, scan.edges, map, prior, prior.predicted(), 0.3);
  EXPECT_LT(match.state.T_odom_base.translation().norm(), 0.1);
  EXPECT_GT(match.upright_inliers, 100u);
  // A little worse than it is, so that the windows of the map decide nothing.
  match.upright_inliers = match.upright_inliers * 9 / 10;
  match.upright = match.upright_inliers * 11 / 10;
  return is_ambiguous(config, matcher, scan, map, {state, covariance, 0.1}, match);
}

TEST(AmbiguitySearch, RowsAtEqualDistancesFitAtSeveralPlaces) {
  EXPECT_TRUE(ambiguous_among({-10.0, -7.5, -5.0, -2.5, 0.0, 2.5, 5.0, 7.5, 10.0, 12.5}));
}

TEST(AmbiguitySearch, APairOfWallsFitsAtOnePlace) { EXPECT_FALSE(ambiguous_among({2.5, 5.0})); }

}  // namespace
}  // namespace fleetmap::odometry
