#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "deskew.hpp"
#include "features.hpp"
#include "fleetmap/odometry/loam_config.hpp"
#include "fleetmap/odometry/local_map.hpp"
#include "motion_prior.hpp"

namespace fleetmap::odometry {

struct MatchResult {
  MotionState state;
  /// Information of [pose, twist] at `state` from the points alone, degenerate directions removed.
  Matrix12d lidar_information = Matrix12d::Zero();
  Matrix12d prior_information = Matrix12d::Zero();
  Vector12d prior_gradient =
      Vector12d::Zero();         ///< prior_information times how far `state` lies from the prior
  std::size_t planes = 0;        ///< plane features with a surface in the map
  std::size_t edges = 0;         ///< edge features with an edge in the map
  double inlier_fraction = 0.0;  ///< of these, the share that lies within 3 sigma
  /// Features that constrain horizontal position and heading (all but level ones) and have a surface or edge
  /// in the map, and their inliers. The ground fits anywhere, so it is not counted.
  std::size_t upright = 0, upright_inliers = 0;
  /// Mean square of the inliers' distances over what they were taken to be, 1 as assumed: how much of its
  /// stated variance the scene really showed (the a posteriori variance of unit weight).
  double residual_variance = 1.0;
  double rms = 0.0;  ///< m, of the inliers' distances to their surfaces and edges
  int degenerate_count = 0;
  int weak_count = 0;  ///< directions among those that follow that noisy normals may still constrain wrongly
  bool speed_measured = false, turn_rate_measured = false;  ///< by wheels; by a gyro or by wheels
  double range = 1.0;                                       ///< m, mean of the matched features
  /// Unit pose directions [m, m, m, and rotation times `range`] that the scene does not
  /// constrain: the first `degenerate_count` columns. There the state follows the prior. The others follow,
  /// the least constrained first.
  Matrix6d degenerate_directions = Matrix6d::Zero();
  int iterations = 0;
  bool converged = false;
};

/// Pose and velocity of a sweep that best lay its features on the map: Gauss-Newton on point-to-plane and
/// point-to-line distances and the motion prior. Each surface counts by its flatness: the variance of a
/// distance is that of the return, of the surface's thickness and of its normal. Robust against moving
/// objects (Geman-McClure, annealed). Directions that the surfaces' normals do not determine beyond their own
/// noise are left to the prior (after Zhang, Kaess and Singh, ICRA 2016).
class ScanMatcher {
 public:
  explicit ScanMatcher(const LoamConfig& config);

  /// `initial_error` m: how far off `start` may be at the distance of typical surfaces.
  MatchResult align(const std::vector<FeaturePoint>& planes, const std::vector<FeaturePoint>& edges,
                    LocalMap& map, const MotionPrior& prior, const MotionState& start, double initial_error);

 private:
  struct TimeBin {
    std::array<double, 21> H;  ///< upper triangle of the pose part
    Vector6d g;
  };
  struct Sums {
    double weight = 0, spurious = 0, range = 0, inlier_square = 0, inlier_normalised = 0,
           inlier_dimensions = 0;
    std::size_t points = 0, inliers = 0, planes = 0, edges = 0, upright = 0, upright_inliers = 0;
  };
  /// The cell in which a plane feature was looked up and the plane found there, since the next iteration
  /// mostly looks up the same.
  struct PlaneLookup {
    CellKey cell = 0;
    const Surface* plane = nullptr;
  };
  static constexpr int kTimeBins = 16;
  struct Linearisation;

  /// Linearises every `stride`-th feature at `state`.
  void linearise(const std::vector<FeaturePoint>& planes, const std::vector<FeaturePoint>& edges,
                 LocalMap& map, const MotionState& state, double slack, std::size_t stride);
  void add_planes(const Linearisation& at, const std::vector<FeaturePoint>& planes, LocalMap& map);
  /// `p` in base_link, `q` in the map's frame.
  void add_feature(const Linearisation& at, const FeaturePoint& feature, const Eigen::Vector3d& p,
                   const Eigen::Vector3d& q, const Surface* surface, bool edge);
  void add_row(TimeBin& bin, const Eigen::Vector3d& p, const Eigen::Vector3d& normal_base, double residual,
               double weight);
  NormalEquations collect() const;
  void fill_statistics(MatchResult& result) const;
  void find_degeneracy(const Matrix12d& H, MatchResult& result) const;

  LoamConfig config_;
  std::array<TimeBin, kTimeBins> bins_;
  double half_span_ = 0.0;
  Sums sums_;
  std::vector<PlaneLookup> lookups_;  ///< of each plane feature, during one align()
};

}  // namespace fleetmap::odometry
