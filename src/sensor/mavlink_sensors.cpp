#include "fleetmap/sensor/mavlink_sensors.hpp"

#include <cmath>
#include <variant>

namespace fleetmap::sensor {
namespace {

/// Another system may take over after the first one was silent for so long.
constexpr Duration kSilence = std::chrono::seconds(5);
/// SCALED_IMU is of the same IMU as HIGHRES_IMU, and coarser.
constexpr Duration kOtherImu = std::chrono::seconds(1);
/// An orientation is turned on for so long at most.
constexpr Duration kOrientationAge = std::chrono::milliseconds(200);

constexpr int kFixWithAltitude = 3;  // GPS_FIX_TYPE_3D_FIX

Eigen::Vector3d flu(const Eigen::Vector3d& frd) { return {frd.x(), -frd.y(), -frd.z()}; }

Eigen::Quaterniond enu_from(const Eigen::Quaterniond& q_ned_frd) {
  const Eigen::Quaterniond q_enu_ned(0.0, M_SQRT1_2, M_SQRT1_2, 0.0);  // swaps x and y, turns z
  const Eigen::Quaterniond q_frd_flu(0.0, 1.0, 0.0, 0.0);              // half a turn about x
  return q_enu_ned * q_ned_frd * q_frd_flu;
}

Eigen::Quaterniond rotation_of(const Eigen::Vector3d& angle) {
  const double norm = angle.norm();
  if (norm < 1e-12) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(norm, angle / norm));
}

}  // namespace

DeviceSamples MavlinkSensors::add(ByteView bytes, Stamp arrival) {
  DeviceSamples samples;
  for (const MavlinkFrame& frame : frames_.add(bytes)) {
    if (frame.id == kMavlinkHeartbeat || frame.id == kMavlinkAttitude) continue;
    if (!is_source(frame, arrival)) {
      ++counters_.of_other_systems;
    } else if (const auto message = decode_mavlink(frame)) {
      std::visit([&](const auto& decoded) { handle(decoded, arrival, samples); }, *message);
    } else {
      ++counters_.unusable;
    }
  }
  return samples;
}

MavlinkSensors::Counters MavlinkSensors::counters() const {
  Counters all = counters_;
  all.frames = frames_.counters();
  return all;
}

bool MavlinkSensors::is_source(const MavlinkFrame& frame, Stamp arrival) {
  const std::pair sender(frame.system, frame.component);
  if (source_ && *source_ != sender && arrival - last_message_ <= kSilence) return false;
  source_ = sender;
  last_message_ = arrival;
  return true;
}

void MavlinkSensors::hear_time(Duration boot, Stamp arrival) {
  if (!clock_.add(boot, arrival)) return;
  ++counters_.restarts;
  unix_minus_boot_.reset();
  attitude_.reset();
}

std::optional<Duration> MavlinkSensors::boot_time(const MavlinkTime& time) {
  if (!time.is_unix) return time.since;
  if (unix_minus_boot_ && time.since >= *unix_minus_boot_) return time.since - *unix_minus_boot_;
  ++counters_.unplaced;
  return std::nullopt;
}

void MavlinkSensors::handle(const MavlinkSystemTime& message, Stamp arrival, DeviceSamples&) {
  hear_time(message.boot, arrival);
  if (message.unix_time) unix_minus_boot_ = *message.unix_time - message.boot;
}

void MavlinkSensors::handle(const MavlinkTimesync& message, Stamp arrival, DeviceSamples&) {
  // Requests of the autopilot's own bear no time of its; others' answers bear a time that was not asked here.
  if (message.device == Duration::zero()) return;
  clock_.add_round_trip(Stamp(message.asked), message.device, arrival);
}

void MavlinkSensors::handle(const MavlinkAttitude& message, Stamp arrival, DeviceSamples&) {
  hear_time(message.boot, arrival);
  attitude_ = message;
}

void MavlinkSensors::handle(const MavlinkGps& message, Stamp, DeviceSamples& samples) {
  // Its time is that of the measurement, long before transmission, so it is not used for the clock.
  const auto boot = boot_time(message.time);
  const auto stamp = boot ? clock_.to_system(*boot) : std::nullopt;
  if (!stamp) return;
  Fix fix{.stamp = *stamp, .position = message.position};
  fix.valid = message.fix_type >= kFixWithAltitude && is_valid(fix.position);
  fix.above_sea_level = fix.valid && !message.has_ellipsoid;
  if (fix.above_sea_level) ++counters_.above_sea_level;
  const double h = message.sigma_h * message.sigma_h, v = message.sigma_v * message.sigma_v;
  if (h > 0.0 && v > 0.0) fix.covariance.diagonal() << h, h, v;
  samples.fixes.push_back(fix);
}

void MavlinkSensors::handle(const MavlinkImu& message, Stamp arrival, DeviceSamples& samples) {
  if (message.high_resolution) last_high_resolution_ = arrival;
  if (!message.high_resolution && last_high_resolution_ && arrival - *last_high_resolution_ < kOtherImu)
    return;
  const auto boot = boot_time(message.time);
  if (!boot) return;
  hear_time(*boot, arrival);
  Imu imu;
  imu.stamp = *clock_.to_system(*boot);
  imu.angular_velocity = flu(message.angular_velocity);
  imu.specific_force = flu(message.specific_force);
  if (attitude_ && std::chrono::abs(*boot - attitude_->boot) <= kOrientationAge) {
    const double since = to_seconds(*boot - attitude_->boot);
    imu.q_enu_imu = enu_from(attitude_->q_ned_frd) * rotation_of(imu.angular_velocity * since);
  }
  samples.imu.push_back(imu);
}

Bytes MavlinkSensors::clock_request(Stamp now) {
  return encode_mavlink(MavlinkTimesync{Duration::zero(), now.time_since_epoch()}, sequence_++);
}

}  // namespace fleetmap::sensor
