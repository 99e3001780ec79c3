#pragma once

#include <optional>

#include "fleetmap/odometry/loam_config.hpp"
#include "scan_matching.hpp"

namespace fleetmap::odometry {

/// Ratio of the prior's squared errors to their predicted variance, over the last seconds.
class PriorMisfit {
 public:
  /// Adds one scan's normalised squared misfit and the number of dimensions that its points measured.
  void add(double squares, double dimensions);
  /// 1 if the errors are as predicted. With few measured dimensions it is near 1.
  double variance() const;

 private:
  double squares_ = 0.0, dimensions_ = 0.0;
};

/// Covariance of LOAM's poses, adapted from scan to scan. Covariances are of right tangents [m, rad].
class PoseUncertainty {
 public:
  explicit PoseUncertainty(LoamConfig config);

  /// Begins with an unknown velocity.
  void start();
  /// The new map begins at the last pose, which has no error in it.
  void map_restarted();
  /// Adds the change of the turn rates between two scans, rad/s^2.
  void turn_changed(const Eigen::Vector3d& change);

  /// One scan as it was matched.
  struct Matched {
    const MatchResult& match;
    bool lost = false;
    Pose T_before_now = Pose::Identity();       ///< between the reference instants of two scans
    Pose T_reference_stamp = Pose::Identity();  ///< from the scan's stamp to its reference instant
    double reference_offset = 0.0;              ///< s from stamp to reference instant
    double half_sweep = 0.0;                    ///< s from the reference instant to the sweep's end
    /// (rad/s^2)^2, from the scatter of the gyro. Without a gyro the mean square of its recent changes is
    /// used, since it may change as much within a sweep.
    std::optional<Eigen::Vector3d> turn_acceleration_variance = std::nullopt;
  };
  struct Stated {
    Matrix6d pose_noise;  ///< of the scan in the local map, at its stamp
    Matrix6d growth;      ///< lost on the way from the scan before
  };
  Stated state(const Matched& scan);

  /// Covariance of the last scan's pose in the local map and of its velocity, for the next scan's prior.
  const Matrix12d& covariance() const { return covariance_; }

 private:
  void remember(const Matrix12d& at_reference);
  void update_prior_misfit(const MatchResult& match, const Matrix12d& covariance, bool gyro);
  Matrix12d error_at_reference(const Matched& scan);
  Matrix6d growth(const Matched& scan, const Matrix6d& noise);
  Matrix6d growth_unheld(const MatchResult& match, const Matrix6d& noise);
  Matrix6d growth_sliding(const MatchResult& match, double way);
  void hold();

  LoamConfig config_;
  Matrix12d covariance_ = Matrix12d::Zero();
  Matrix6d last_noise_ = Matrix6d::Zero();     ///< of the last scan's pose at its reference instant
  double unheld_share_ = 0.0;                  ///< of the map near: built of scans that it does not hold
  double slid_ = 0.0;                          ///< m, 1 sigma, since most of the map near is of that kind
  MatchResult sliding_;                        ///< the last scan with degenerate directions
  Matrix6d unheld_stated_ = Matrix6d::Zero();  ///< growth since a scan was last held in all directions
  /// (rad/s^2)^2, mean square of how the turn rates changed from scan to scan.
  Eigen::Vector3d turn_change_ = Eigen::Vector3d::Zero();
  PriorMisfit translation_misfit_, rotation_misfit_;
};

}  // namespace fleetmap::odometry
