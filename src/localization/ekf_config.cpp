#include "fleetmap/localization/ekf_config.hpp"

#include <cmath>
#include <string>

namespace fleetmap::localization {
namespace {

struct Field {
  const char* name;
  double value;
};

}  // namespace

Status EkfConfig::validate() const {
  const Field positive[] = {
      {"imu.gyro_noise", imu.gyro_noise},
      {"imu.accel_noise", imu.accel_noise},
      {"imu.gyro_bias_sigma", imu.gyro_bias_sigma},
      {"imu.accel_bias_sigma", imu.accel_bias_sigma},
      {"imu.gravity", imu.gravity},
      {"imu.max_gap", imu.max_gap},
      {"imu.orientation_tilt_tolerance", imu.orientation_tilt_tolerance},
      {"imu.orientation_yaw_sigma", imu.orientation_yaw_sigma},
      {"imu.orientation_yaw_floor", imu.orientation_yaw_floor},
      {"gps.default_sigma_h", gps.default_sigma_h},
      {"gps.default_sigma_v", gps.default_sigma_v},
      {"gps.sigma_floor", gps.sigma_floor},
      {"gps.gate", gps.gate},
      {"gps.max_speed", gps.max_speed},
      {"gps.max_site_radius", gps.max_site_radius},
      {"gps.recovery_time", gps.recovery_time},
      {"gps.recovery_time_far", gps.recovery_time_far},
      {"wheel.speed_sigma", wheel.speed_sigma},
      {"wheel.yaw_rate_sigma", wheel.yaw_rate_sigma},
      {"wheel.lateral_sigma", wheel.lateral_sigma},
      {"wheel.vertical_sigma", wheel.vertical_sigma},
      {"wheel.timeout", wheel.timeout},
      {"wheel.gate", wheel.gate},
      {"motion.accel_noise", motion.accel_noise},
      {"motion.yaw_noise", motion.yaw_noise},
      {"motion.yaw_noise_with_wheels", motion.yaw_noise_with_wheels},
      {"motion.tilt_sigma", motion.tilt_sigma},
      {"motion.tilt_time", motion.tilt_time},
      {"motion.speed_sigma", motion.speed_sigma},
      {"motion.heading_sigma", motion.heading_sigma},
      {"history", history},
      {"max_time_jump", max_time_jump},
  };
  for (const Field& field : positive) {
    if (!(field.value > 0.0) || !std::isfinite(field.value)) {
      return failure(std::string(field.name) + ": must be finite and > 0");
    }
  }
  const Field not_negative[] = {
      {"imu.gyro_bias_walk", imu.gyro_bias_walk},
      {"imu.accel_bias_walk", imu.accel_bias_walk},
      {"gps.correlation_time", gps.correlation_time},
      {"wheel.speed_scale", wheel.speed_scale},
      {"wheel.turn_offset", wheel.turn_offset},
      {"wheel.correlation_time", wheel.correlation_time},
      {"max_lateness", max_lateness},
      {"max_extrapolation", max_extrapolation},
      {"gps.correlated_share", gps.correlated_share},
  };
  for (const Field& field : not_negative) {
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
