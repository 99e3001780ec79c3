#include "fleetmap/localization/ekf_config.hpp"

#include <array>
#include <cmath>
#include <string>

namespace fleetmap::localization {
namespace {

struct Field {
  const char* name;
  double value;
};

/// Numbers that must be positive.
auto positive(const EkfConfig& config) {
  return std::array{
      Field{"imu.gyro_noise", config.imu.gyro_noise},
      Field{"imu.accel_noise", config.imu.accel_noise},
      Field{"imu.gyro_bias_sigma", config.imu.gyro_bias_sigma},
      Field{"imu.accel_bias_sigma", config.imu.accel_bias_sigma},
      Field{"imu.gravity", config.imu.gravity},
      Field{"imu.max_gap", config.imu.max_gap},
      Field{"imu.orientation_tilt_tolerance", config.imu.orientation_tilt_tolerance},
      Field{"imu.orientation_yaw_sigma", config.imu.orientation_yaw_sigma},
      Field{"imu.orientation_yaw_floor", config.imu.orientation_yaw_floor},
      Field{"gps.default_sigma_h", config.gps.default_sigma_h},
      Field{"gps.default_sigma_v", config.gps.default_sigma_v},
      Field{"gps.sigma_floor", config.gps.sigma_floor},
      Field{"gps.gate", config.gps.gate},
      Field{"gps.max_speed", config.gps.max_speed},
      Field{"gps.max_site_radius", config.gps.max_site_radius},
      Field{"gps.recovery_time", config.gps.recovery_time},
      Field{"gps.recovery_time_far", config.gps.recovery_time_far},
      Field{"wheel.speed_sigma", config.wheel.speed_sigma},
      Field{"wheel.yaw_rate_sigma", config.wheel.yaw_rate_sigma},
      Field{"wheel.lateral_sigma", config.wheel.lateral_sigma},
      Field{"wheel.vertical_sigma", config.wheel.vertical_sigma},
      Field{"wheel.timeout", config.wheel.timeout},
      Field{"wheel.gate", config.wheel.gate},
      Field{"motion.accel_noise", config.motion.accel_noise},
      Field{"motion.yaw_noise", config.motion.yaw_noise},
      Field{"motion.yaw_noise_with_wheels", config.motion.yaw_noise_with_wheels},
      Field{"motion.tilt_sigma", config.motion.tilt_sigma},
      Field{"motion.tilt_time", config.motion.tilt_time},
      Field{"motion.speed_sigma", config.motion.speed_sigma},
      Field{"motion.heading_sigma", config.motion.heading_sigma},
      Field{"history", config.history},
      Field{"max_time_jump", config.max_time_jump},
  };
}

/// Numbers that must not be negative.
auto not_negative(const EkfConfig& config) {
  return std::array{
      Field{"imu.gyro_bias_walk", config.imu.gyro_bias_walk},
      Field{"imu.accel_bias_walk", config.imu.accel_bias_walk},
      Field{"gps.correlation_time", config.gps.correlation_time},
      Field{"wheel.speed_scale", config.wheel.speed_scale},
      Field{"wheel.turn_offset", config.wheel.turn_offset},
      Field{"wheel.correlation_time", config.wheel.correlation_time},
      Field{"max_lateness", config.max_lateness},
      Field{"max_extrapolation", config.max_extrapolation},
      Field{"gps.correlated_share", config.gps.correlated_share},
  };
}

}  // namespace

Status EkfConfig::validate() const {
  for (const Field& field : positive(*this)) {
    if (!(field.value > 0.0) || !std::isfinite(field.value)) {
      return failure(std::string(field.name) + ": must be finite and > 0");
    }
  }
  for (const Field& field : not_negative(*this)) {
    if (!(field.value >= 0.0) || !std::isfinite(field.value)) {
      return failure(std::string(field.name) + ": must be finite and >= 0");
    }
  }
  if (gps.correlated_share > 0.99) return failure("gps.correlated_share: must be <= 0.99");
  if (!(gps.sigma_ceiling >= gps.sigma_floor) || !std::isfinite(gps.sigma_ceiling)) {
    return failure("gps.sigma_ceiling: must be finite and >= gps.sigma_floor");
  }
  if (gps.initial_fixes < 1) return failure("gps.initial_fixes: must be >= 1");
  if (max_lateness > history) return failure("max_lateness: must be <= history");
  if (!all_finite(mounting.T_base_imu)) return failure("mounting.T_base_imu: must be finite");
  if (!mounting.p_base_antenna.allFinite()) return failure("mounting.p_base_antenna: must be finite");
  if (site_origin && !is_valid(*site_origin)) return failure("site_origin: must be a point on Earth");
  return {};
}

}  // namespace fleetmap::localization
