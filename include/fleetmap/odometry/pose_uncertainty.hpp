#pragma once

#include <optional>

#include "fleetmap/odometry/loam_config.hpp"
#include "fleetmap/odometry/scan_matching.hpp"

namespace fleetmap::odometry {

/// How far the prior was off over how far it was taken to be, of the last seconds.
class PriorMisfit {
 public:
  /// Adds one scan's normalised squared misfit and the number of dimensions that its points measured.
  void add(double squares, double dimensions);
  /// 1: as taken to be. Told by few points it is near 1.
  double variance() const;

 private:
  double squares_ = 0.0, dimensions_ = 0.0;
};

/// How far LOAM's poses may be off, learned from scan to scan. Covariances are of right tangents [m, rad].
class PoseUncertainty {
 public:
  explicit PoseUncertainty(LoamConfig config);

  /// The velocity is not known.
  void start();
  /// The last pose is where the new map begins, so known in it.
  void map_restarted();
  /// From one scan to the next the turn rates changed by so much a second [rad/s^2].
  void turn_changed(const Eigen::Vector3d& change);

  /// One scan as it was matched.
  struct Matched {
    const MatchResult& match;
    bool lost = false;
    Pose T_before_now = Pose::Identity();       ///< between the reference instants of two scans
    Pose T_reference_stamp = Pose::Identity();  ///< from the scan's stamp to its reference instant
    double reference_offset = 0.0;              ///< s from stamp to reference instant
    double half_sweep = 0.0;                    ///< s from the reference instant to the sweep's end
    /// (rad/s^2)^2, as the gyro's own scatter says; without a gyro it is as much as it has changed of late,
    /// for within a sweep it may change as much again.
    std::optional<Eigen::Vector3d> turn_acceleration_variance = std::nullopt;
  };
  struct Stated {
    Matrix6d pose_noise;  ///< of the scan in the local map, at its stamp
    Matrix6d growth;      ///< what was lost on the way from the scan before
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
