#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <variant>

#include "fleetmap/core/time.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/localization/ekf_config.hpp"
#include "fleetmap/localization/heading_alignment.hpp"
#include "fleetmap/sensor/samples.hpp"

namespace fleetmap::localization {

/// Error state: position (m, ENU), velocity (m/s, ENU), attitude (rad, ENU axes: R_true = exp(theta) R), gyro
/// bias (rad/s) and accelerometer bias (m/s^2) in the IMU frame: 15 states. Three more carry the slow part of
/// the GPS error as a first-order Gauss-Markov process (GpsModel), in units of its standard deviation; with
/// gps.correlation_time = 0 they stay at 0 and touch nothing.
inline constexpr int kStates = 18;
enum StateOffset : int { kPos = 0, kVel = 3, kAtt = 6, kGyroBias = 9, kAccelBias = 12, kGpsError = 15 };
using Covariance = Eigen::Matrix<double, kStates, kStates>;
using ErrorState = Eigen::Matrix<double, kStates, 1>;

/// Counts how samples were used or why they were refused. Times refer to each sensor's own stamps.
struct EkfCounters {
  std::uint64_t imu_used = 0;
  std::uint64_t imu_bad_value = 0;  ///< NaN, or beyond what any device measures
  std::uint64_t imu_bad_time = 0;   ///< not after the one before, too late, or an unconfirmed jump
  std::uint64_t imu_gaps = 0;       ///< longer than imu.max_gap, bridged by the motion model
  std::uint64_t orientations_inconsistent = 0;  ///< reported orientation contradicts gravity
  std::uint64_t wheel_used = 0;
  std::uint64_t wheel_bad_value = 0;
  std::uint64_t wheel_bad_time = 0;
  std::uint64_t wheel_downweighted = 0;  ///< used, but beyond wheel.gate
  std::uint64_t fix_used = 0;
  std::uint64_t fix_pending = 0;  ///< awaited confirmation by gps.initial_fixes
  std::uint64_t fix_invalid = 0;  ///< no fix, NaN, not on Earth, or exactly 0, 0
  std::uint64_t fix_bad_time = 0;
  std::uint64_t fix_implausible = 0;          ///< too far from the site, or from the last fix in that time
  std::uint64_t fix_gated = 0;                ///< beyond gps.gate
  std::uint64_t fix_covariance_replaced = 0;  ///< used with gps.default_sigma_*
  std::uint64_t fix_recoveries = 0;      ///< rejected fixes that agreed for so long that they were accepted
  std::uint64_t heading_alignments = 0;  ///< heading taken from motion
  std::uint64_t heading_resets = 0;      ///< of these, those that replaced an earlier heading
  std::uint64_t restarts = 0;            ///< the clock stepped back for good: everything began anew
  std::uint64_t heading_lost = 0;        ///< heading became too uncertain to go on with
};

using Sample = std::variant<sensor::Imu, sensor::Wheel, sensor::Fix>;

/// Part of the robot's pose that the filter estimates.
enum class Phase {
  kWaiting,   ///< no position yet
  kCoarse,    ///< position of the last fix, level, heading unknown
  kTracking,  ///< everything is estimated
};

/// A run of rejected fixes. It is accepted once enough of them agree with one another.
struct FixRun {
  int count = 0;
  Stamp first;
  Stamp last;
  GeoPoint position;
  double sigma = 0.0;  ///< m
};

/// The whole memory of the EKF: a value, so that time can be turned back by keeping copies.
struct Filter {
  Stamp stamp;
  Phase phase = Phase::kWaiting;
  bool started = false;       ///< a sample has been seen, `stamp` is meaningful
  bool attitude_set = false;  ///< R is level (and its heading arbitrary until `heading_set`)
  bool heading_set = false;
  std::optional<LocalFrame> frame;

  Eigen::Vector3d p = Eigen::Vector3d::Zero();           ///< p_enu_base, m
  Eigen::Vector3d v = Eigen::Vector3d::Zero();           ///< of base_link in ENU, m/s
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();       ///< R_enu_base
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();   ///< rad/s, IMU frame
  Eigen::Vector3d accel_bias = Eigen::Vector3d::Zero();  ///< m/s^2, IMU frame
  Eigen::Vector3d gps_error = Eigen::Vector3d::Zero();   ///< 1, in standard deviations
  Covariance P = Covariance::Zero();

  std::optional<sensor::Imu> last_imu;
  std::optional<sensor::Wheel> last_wheel;
  std::optional<Stamp> last_fix;  ///< the last that was used
  GeoPoint last_fix_position;
  double last_fix_sigma = 0.0;  ///< m, worst axis
  FixRun rejected_run;
  double yaw_turned = 0.0;  ///< rad, dead reckoned since the start; never corrected
  HeadingAlignment alignment;
  int heading_contradictions = 0;  ///< consecutive estimates from motion that contradict R
  EkfCounters counters;
};

/// Takes one sample whose stamp is not before `filter.stamp`.
void apply(const EkfConfig& config, Filter& filter, const Sample& sample);

/// Predicts the filter to `stamp` (last IMU sample held, or the motion model).
void predict_to(const EkfConfig& config, Filter& filter, Stamp stamp);

Stamp stamp_of(const Sample& sample);

}  // namespace fleetmap::localization
