#pragma once

#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/odometry/loam.hpp"

namespace fleetmap::odometry {

/// Covariance of the motion between two scans of one odometry frame, right tangent [m, rad]: the drift on the
/// way, which sums, and the noise of the two end poses in the local map, which does not. Every update of the
/// frame must be added.
class MotionCovariance {
 public:
  /// The next scan of the motion; the first one is its reference.
  void add(const OdometryUpdate& update) { add(update.T_odom_base, update.covariance, update.pose_noise); }
  void add(const Pose& T_odom_base, const Matrix6d& growth, const Matrix6d& pose_noise);
  /// The last scan becomes the reference, as at a new node.
  void restart();
  /// Covariance of T_reference_last, right tangent: T <- T exp(d). Zero before the first scan and at the
  /// reference itself.
  Matrix6d since_reference() const;
  /// The drift alone, which sums over successive motions. The noise of the end poses in the local map does
  /// not, since the end of one motion is the reference of the next.
  Matrix6d drift_since_reference() const;

 private:
  bool started_ = false, moved_ = false;
  Pose T_odom_base_ = Pose::Identity();          ///< of the last scan
  Matrix6d growth_ = Matrix6d::Zero();           ///< since the reference, at the last scan
  Matrix6d reference_noise_ = Matrix6d::Zero();  ///< of the reference, seen from the last scan
  Matrix6d last_noise_ = Matrix6d::Zero();
};

}  // namespace fleetmap::odometry
