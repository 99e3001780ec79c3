#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <vector>

#include "fleetmap/odometry/loam.hpp"
#include "fleetmap/odometry/motion_covariance.hpp"

namespace fleetmap::odometry {

/// Checks whether a trajectory is reliable, over the whole drive and along it, since a long drive hides a
/// stretch that was lost. All updates are of one odometry frame, in order.
class TrajectoryCheck {
 public:
  void add(const OdometryUpdate& update);

  double length() const { return length_; }  ///< m
  /// Covariance of the motion from the first to the last update.
  Matrix6d covariance() const { return whole_.since_reference(); }
  /// Reasons why the trajectory is unreliable, each with the time at which it is worst; empty if there are
  /// none.
  std::vector<std::string> warnings() const;

 private:
  struct RecentScan {
    Stamp stamp;
    bool lost;
  };
  struct Worst {
    double value = 0.0;
    Stamp at;  ///< end of the stretch
  };

  void update_losses(const OdometryUpdate& update);
  void update_stretch(const OdometryUpdate& update);
  std::string after_start(Stamp stamp) const;

  Stamp first_;
  Pose last_ = Pose::Identity();
  std::size_t updates_ = 0, lost_ = 0;
  double length_ = 0.0, stretch_begin_ = 0.0;  ///< m
  MotionCovariance whole_, stretch_;
  std::deque<RecentScan> recent_;
  std::size_t recent_lost_ = 0;
  Worst losses_;          ///< share of the scans
  Worst vague_, turned_;  ///< m, rad, 1 sigma over a stretch
};

}  // namespace fleetmap::odometry
