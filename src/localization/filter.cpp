#include "fleetmap/localization/filter.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "fix_screening.hpp"
#include "prediction.hpp"
#include "updates.hpp"

namespace fleetmap::localization {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kUnknownYawVariance = std::numbers::pi * std::numbers::pi / 3.0;  // uniform over the circle
constexpr double kLostYawVariance = 1.0;  ///< rad^2 at which linearisation has no meaning
constexpr double kMinResetYaw = 0.5;      ///< rad; smaller errors the filter mends by itself
constexpr int kContradictionsToReset = 3;
constexpr int kMinFixesToRecover = 5;
constexpr double kMotionStep = 0.5;  ///< s

void start(const EkfConfig& config, Filter& filter, Stamp stamp) {
  filter.stamp = stamp;
  filter.started = true;
  const auto square = [](double x) { return x * x; };
  auto diagonal = filter.P.diagonal();
  diagonal.segment<3>(kVel).setConstant(square(config.motion.speed_sigma));
  diagonal.segment<2>(kAtt).setConstant(square(config.motion.tilt_sigma));
  diagonal(kAtt + 2) = kUnknownYawVariance;
  diagonal.segment<3>(kGyroBias).setConstant(square(config.imu.gyro_bias_sigma));
  diagonal.segment<3>(kAccelBias).setConstant(square(config.imu.accel_bias_sigma));
  diagonal.segment<3>(kGpsError).setOnes();
}

void forget_correlations(Covariance& P, int offset, int size) {
  const Eigen::MatrixXd own = P.block(offset, offset, size, size);
  P.middleRows(offset, size).setZero();
  P.middleCols(offset, size).setZero();
  P.block(offset, offset, size, size) = own;
}

/// Moves the antenna to the fix; the position now has the covariance of that fix.
void set_position(const EkfConfig& config, Filter& filter, const Vector3d& p_enu_antenna, const Matrix3d& R) {
  const Vector3d arm = filter.R * config.mounting.p_base_antenna;
  filter.p = p_enu_antenna - arm;
  forget_correlations(filter.P, kPos, 3);
  forget_correlations(filter.P, kGpsError, 3);
  filter.gps_error.setZero();
  filter.P.block<3, 3>(kGpsError, kGpsError).setIdentity();
  Matrix3d C = R;
  if (!filter.heading_set) C.topLeftCorner<2, 2>().diagonal().array() += arm.head<2>().squaredNorm();
  filter.P.block<3, 3>(kPos, kPos) = C;
  if (config.gps.correlation_time > 0.0) {
    const Matrix3d L = (config.gps.correlated_share * R).llt().matrixL();
    filter.P.block<3, 3>(kPos, kGpsError) = -L;
    filter.P.block<3, 3>(kGpsError, kPos) = -L.transpose();
  }
}

void begin_tracking(const EkfConfig& config, Filter& filter) {
  filter.phase = Phase::kTracking;
  filter.heading_contradictions = 0;
  const sensor::Wheel* wheel = recent_wheel(config, filter);
  filter.v = filter.R * Vector3d(wheel != nullptr ? wheel->forward_speed : 0.0, 0, 0);
  forget_correlations(filter.P, kVel, 3);
  Matrix3d C = Matrix3d::Identity() * std::pow(config.motion.speed_sigma, 2);
  if (wheel != nullptr) {
    C = Matrix3d::Identity() * 0.25;
    // The velocity is along the heading, so it is wrong where the heading is.
    const Vector3d across = Vector3d::UnitZ().cross(filter.v);
    const double yaw_variance = filter.P(kAtt + 2, kAtt + 2);
    C += across * across.transpose() * yaw_variance;
    filter.P.block<3, 1>(kVel, kAtt + 2) = across * yaw_variance;
    filter.P.block<1, 3>(kAtt + 2, kVel) = across.transpose() * yaw_variance;
  }
  filter.P.block<3, 3>(kVel, kVel) = C;
}

void set_heading(Filter& filter, double yaw, double variance) {
  const Matrix3d turn = rotation_from_rpy(0, 0, yaw - yaw_of(filter.R));
  filter.R = turn * filter.R;
  forget_correlations(filter.P, kAtt + 2, 1);
  filter.P(kAtt + 2, kAtt + 2) = variance;
  filter.heading_set = true;
}

/// Level from gravity, heading 0 for now.
void set_level(const EkfConfig& config, Filter& filter, const Vector3d& f_base) {
  const double norm = f_base.norm();
  if (norm < 0.5 * config.imu.gravity || norm > 1.5 * config.imu.gravity) return;
  const double roll = std::atan2(f_base.y(), f_base.z());
  const double pitch = std::atan2(-f_base.x(), std::hypot(f_base.y(), f_base.z()));
  filter.R = rotation_from_rpy(roll, pitch, 0.0);
  filter.attitude_set = true;
}

/// Heading from the device's own orientation, if that agrees with gravity.
void try_reported_orientation(const EkfConfig& config, Filter& filter, const sensor::Imu& imu) {
  if (!config.imu.use_orientation || !imu.q_enu_imu) return;
  const double norm = imu.q_enu_imu->norm();
  const Matrix3d R_base_imu = config.mounting.T_base_imu.linear();
  bool consistent = std::isfinite(norm) && std::abs(norm - 1.0) < 0.05;
  Matrix3d R = Matrix3d::Identity();
  if (consistent) {
    R = imu.q_enu_imu->normalized().toRotationMatrix() * R_base_imu.transpose();
    const Vector3d up_reported = R.row(2).transpose();
    const Vector3d up_measured = (R_base_imu * imu.specific_force).normalized();
    const double angle = std::atan2(up_reported.cross(up_measured).norm(), up_reported.dot(up_measured));
    consistent = angle <= config.imu.orientation_tilt_tolerance;
  }
  if (!consistent) {
    ++filter.counters.orientations_inconsistent;
    return;
  }
  const double reported = imu.orientation_variance.z();
  const double floor = config.imu.orientation_yaw_floor * config.imu.orientation_yaw_floor;
  const double assumed = config.imu.orientation_yaw_sigma * config.imu.orientation_yaw_sigma;
  const double variance = std::isfinite(reported) && reported > 0.0 ? std::max(reported, floor) : assumed;
  if (variance > kLostYawVariance) return;
  set_heading(filter, yaw_of(R), variance);
  if (filter.phase == Phase::kCoarse) begin_tracking(config, filter);
}

void take_imu(const EkfConfig& config, Filter& filter, const sensor::Imu& imu) {
  const double dt = to_seconds(imu.stamp - filter.stamp);
  const double since_last = filter.last_imu ? to_seconds(imu.stamp - filter.last_imu->stamp) : 0.0;
  if (filter.last_imu && since_last <= config.imu.max_gap && filter.attitude_set) {
    const sensor::Imu& last = *filter.last_imu;
    const double left = since_last > 0.0 ? dt / since_last : 0.0;  // share of the interval not yet predicted
    const Vector3d rate_change = left * (imu.angular_velocity - last.angular_velocity);
    const Vector3d force_change = left * (imu.specific_force - last.specific_force);
    predict_inertial(config, filter, dt, imu.angular_velocity - 0.5 * rate_change,
                     imu.specific_force - 0.5 * force_change, rate_change, force_change);
    filter.stamp = imu.stamp;
  } else {
    if (filter.last_imu && since_last > config.imu.max_gap) ++filter.counters.imu_gaps;
    predict_to(config, filter, imu.stamp);
  }
  filter.last_imu = imu;
  ++filter.counters.imu_used;
  if (!filter.attitude_set) {
    set_level(config, filter, config.mounting.T_base_imu.linear() * imu.specific_force);
  }
  if (!filter.attitude_set) return;
  if (filter.phase != Phase::kTracking) update_from_gravity(config, filter, imu, dt);
  if (!filter.heading_set) try_reported_orientation(config, filter, imu);
}

/// Heading from the last metres driven: the first one, or one that replaces a heading that several
/// displacements contradict.
void watch_heading(const EkfConfig& config, Filter& filter, const Vector3d& p_enu_antenna,
                   const Matrix3d& R) {
  const double sigma = std::sqrt(std::max(R(0, 0), R(1, 1)));
  const bool odometer = recent_wheel(config, filter) != nullptr;
  const bool gyro =
      filter.last_imu && to_seconds(filter.stamp - filter.last_imu->stamp) <= config.imu.max_gap;
  if (!odometer && !gyro) return;  // a track without turns or lengths is no track
  const Eigen::Vector2d arm =
      Eigen::Rotation2Dd(filter.yaw_turned) * config.mounting.p_base_antenna.head<2>();
  const bool added =
      odometer ? filter.alignment.add_fix(p_enu_antenna.head<2>(), sigma, arm)
               : filter.alignment.add_fix_without_odometer(p_enu_antenna.head<2>(), sigma, filter.yaw_turned);
  if (!added) return;
  const auto estimate = filter.alignment.estimate();
  if (!estimate || estimate->sigma > config.motion.heading_sigma) return;
  const double yaw = wrap_angle(estimate->yaw_offset + filter.yaw_turned);
  if (filter.phase == Phase::kTracking) {
    // Without an odometer a reversing robot is indistinguishable from one with the opposite heading.
    const double sigma_both = std::hypot(estimate->sigma, std::sqrt(filter.P(kAtt + 2, kAtt + 2)));
    const bool contradicts =
        odometer && std::abs(wrap_angle(yaw - yaw_of(filter.R))) > std::max(kMinResetYaw, 4.0 * sigma_both);
    filter.heading_contradictions = contradicts ? filter.heading_contradictions + 1 : 0;
    if (filter.heading_contradictions < kContradictionsToReset) return;
    ++filter.counters.heading_resets;
  }
  lose_heading(config, filter);
  set_heading(filter, yaw, estimate->sigma * estimate->sigma);
  set_position(config, filter, p_enu_antenna, R);
  begin_tracking(config, filter);
  ++filter.counters.heading_alignments;
}

void accept_fix(Filter& filter, const sensor::Fix& fix, double sigma) {
  filter.last_fix = fix.stamp;
  filter.last_fix_position = fix.position;
  filter.last_fix_sigma = sigma;
  filter.rejected_run.count = 0;
  ++filter.counters.fix_used;
}

void begin_at(const EkfConfig& config, Filter& filter, const sensor::Fix& fix, const Matrix3d& R) {
  filter.frame = LocalFrame(config.site_origin.value_or(fix.position));
  filter.alignment.clear();
  filter.attitude_set = true;  // level by assumption where no IMU measures gravity
  filter.phase = Phase::kCoarse;
  set_position(config, filter, filter.frame->to_enu(fix.position), R);
  if (filter.heading_set) begin_tracking(config, filter);
}

/// Handles a rejected fix. Enough of them that agree for long enough are accepted after all.
void on_rejected_fix(const EkfConfig& config, Filter& filter, const sensor::Fix& fix, const Matrix3d& R,
                     double sigma, bool far) {
  extend_run(filter.rejected_run, fix, sigma, config.gps);
  const double needed = far ? config.gps.recovery_time_far : config.gps.recovery_time;
  if (filter.rejected_run.count < kMinFixesToRecover) return;
  if (to_seconds(filter.rejected_run.last - filter.rejected_run.first) < needed) return;
  if (far && config.site_origin) return;
  ++filter.counters.fix_recoveries;
  if (far) {
    lose_heading(config, filter);
    begin_at(config, filter, fix, R);
  } else {
    filter.alignment.clear();
    set_position(config, filter, filter.frame->to_enu(fix.position), R);
    // The cause of the filter's divergence may have corrupted these, too.
    filter.P.diagonal().segment<3>(kVel).array() += 1.0;
    filter.P(kAtt + 2, kAtt + 2) += 0.1;
  }
  accept_fix(filter, fix, sigma);
}

void take_fix(const EkfConfig& config, Filter& filter, const sensor::Fix& fix) {
  predict_to(config, filter, fix.stamp);
  if (!is_usable(fix)) {
    ++filter.counters.fix_invalid;
    return;
  }
  const BoundedCovariance bounded = bounded_covariance(fix.covariance, config.gps);
  if (bounded.replaced) ++filter.counters.fix_covariance_replaced;
  const Matrix3d& R = bounded.R;
  const double sigma = std::sqrt(R.diagonal().maxCoeff());
  const GeoPoint* origin = config.site_origin ? &*config.site_origin
                           : filter.frame     ? &filter.frame->origin()
                                              : nullptr;
  const bool far =
      origin != nullptr && haversine_distance(*origin, fix.position) > config.gps.max_site_radius;

  if (filter.phase == Phase::kWaiting) {
    if (far) {
      ++filter.counters.fix_implausible;
      return;
    }
    extend_run(filter.rejected_run, fix, sigma, config.gps);
    if (filter.rejected_run.count < config.gps.initial_fixes) {
      ++filter.counters.fix_pending;
      return;
    }
    begin_at(config, filter, fix, R);
    accept_fix(filter, fix, sigma);
    return;
  }
  if (far || !is_reachable(filter.last_fix_position, fix.position, to_seconds(fix.stamp - *filter.last_fix),
                           std::max(sigma, filter.last_fix_sigma), config.gps)) {
    ++filter.counters.fix_implausible;
    on_rejected_fix(config, filter, fix, R, sigma, far);
    return;
  }
  const Vector3d p_enu_antenna = filter.frame->to_enu(fix.position);
  if (filter.phase == Phase::kCoarse) {
    set_position(config, filter, p_enu_antenna, R);
  } else if (!update_from_position(config, filter, p_enu_antenna, R)) {
    ++filter.counters.fix_gated;
    on_rejected_fix(config, filter, fix, R, sigma, false);
    return;
  } else if (recent_wheel(config, filter) == nullptr) {
    update_nonholonomic(config, filter);
  }
  accept_fix(filter, fix, sigma);
  watch_heading(config, filter, p_enu_antenna, R);
}

}  // namespace

Stamp stamp_of(const Sample& sample) {
  return std::visit([](const auto& s) { return s.stamp; }, sample);
}

void predict_to(const EkfConfig& config, Filter& filter, Stamp stamp) {
  if (filter.last_imu && filter.attitude_set &&
      to_seconds(stamp - filter.last_imu->stamp) <= config.imu.max_gap) {
    const double dt = to_seconds(stamp - filter.stamp);
    if (dt > 0.0) {
      predict_inertial(config, filter, dt, filter.last_imu->angular_velocity, filter.last_imu->specific_force,
                       Vector3d::Zero(), Vector3d::Zero());
    }
  } else {
    // Short steps while a wheel sample is fresh, then all the rest in one.
    for (int step = 0; filter.stamp < stamp; ++step) {
      const Duration left = stamp - filter.stamp;
      const Duration taken = step < 8 ? std::min(left, from_seconds(kMotionStep)) : left;
      predict_by_motion_model(config, filter, to_seconds(taken));
      filter.stamp += taken;
    }
  }
  filter.stamp = stamp;
  if (filter.phase == Phase::kTracking && filter.P(kAtt + 2, kAtt + 2) > kLostYawVariance) {
    ++filter.counters.heading_lost;
    lose_heading(config, filter);
  }
}

void apply(const EkfConfig& config, Filter& filter, const Sample& sample) {
  if (!filter.started) start(config, filter, stamp_of(sample));
  if (const auto* imu = std::get_if<sensor::Imu>(&sample)) return take_imu(config, filter, *imu);
  if (const auto* fix = std::get_if<sensor::Fix>(&sample)) return take_fix(config, filter, *fix);
  const auto& wheel = std::get<sensor::Wheel>(sample);
  predict_to(config, filter, wheel.stamp);
  update_from_wheel(config, filter, wheel);
}

}  // namespace fleetmap::localization
