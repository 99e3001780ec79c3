#pragma once

#include <array>
#include <deque>
#include <optional>

#include "fleetmap/geometry/global_pose.hpp"
#include "fleetmap/localization/ekf_config.hpp"
#include "fleetmap/localization/filter.hpp"
#include "fleetmap/sensor/samples.hpp"

namespace fleetmap::localization {

/// Error-state EKF of GPS, IMU and wheel odometry at base_link. Computes G of the paper with its covariance
/// C_ekf.
///
/// Any of the three sensors may be missing or pause: without IMU a constant-velocity model steered by the
/// wheels' yaw rate is used, without wheels a non-holonomic constraint and GPS bound the velocity, and
/// without GPS the covariance grows. Roll and pitch are observed through gravity, heading through the IMU's
/// reported orientation or through motion.
///
/// Samples of different sensors may arrive in any order within `max_lateness`: a late sample turns the
/// filter back to its stamp and all later ones are applied again, so the result does not depend on the order
/// of arrival. Samples of one sensor must have increasing stamps. Earth rotation and curvature within the
/// site are neglected in the dynamics.
class Ekf {
 public:
  /// `config` must be valid.
  explicit Ekf(const EkfConfig& config) : config_(config) {}
  /// Before the first sample of a sensor whose mount it changes.
  void set_mounting(const Mounting& mounting) { config_.mounting = mounting; }

  /// True if the sample was taken into account; a fix may still be refused by the filter, see counters().
  bool add(const sensor::Imu& imu);
  bool add(const sensor::Wheel& wheel);
  bool add(const sensor::Fix& fix);

  /// G at the newest sample. Empty until the first fixes are accepted. While the heading is unknown its
  /// variance is pi^2/3 (uniform), and the position is that of the last fix, with the distance driven since
  /// as uncertainty.
  std::optional<GlobalPose> pose() const;
  /// G at `stamp`: interpolated between the samples around it, extrapolated up to max_extrapolation past the
  /// newest. Empty outside the history, and where there was no pose yet.
  std::optional<GlobalPose> pose_at(Stamp stamp) const;

  bool heading_known() const { return newest().phase == Phase::kTracking; }
  /// ENU frame of the site; none until its origin is set.
  std::optional<LocalFrame> frame() const { return newest().frame; }
  /// The estimate at the newest sample, with velocity and biases.
  const Filter& newest() const { return records_.empty() ? base_ : records_.back().after; }
  EkfCounters counters() const;

 private:
  struct Record {
    Sample sample;
    Filter after;
  };

  bool admit(Stamp stamp, std::size_t sensor);
  void insert(Sample sample);
  void restart();

  EkfConfig config_;
  Filter base_;                 ///< before the oldest record
  std::deque<Record> records_;  ///< ordered by stamp, at equal stamps IMU, wheel, fix
  std::array<std::optional<Stamp>, 3> last_of_sensor_;
  std::optional<Stamp> unconfirmed_jump_;
  int consecutive_behind_ = 0;  ///< samples far older than the newest, with none in time between them
  EkfCounters refused_;         ///< samples that never reached the filter
};

/// G of a filter that has a position.
std::optional<GlobalPose> global_pose(const Filter& filter);

}  // namespace fleetmap::localization
