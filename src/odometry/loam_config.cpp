#include "fleetmap/odometry/loam_config.hpp"

#include <array>
#include <cmath>
#include <string>

namespace fleetmap::odometry {
namespace {

struct Bound {
  const char* field;
  double value;
  double low;
  double high;
};

/// The range of each number, ends included.
auto bounds_of(const LoamConfig& config) {
  return std::array{
      Bound{"min_range", config.min_range, 0.0, 100.0},
      Bound{"max_range", config.max_range, 1.0, 1000.0},
      Bound{"range_noise", config.range_noise, 1e-4, 1.0},
      Bound{"feature_half_width", config.feature_half_width, 0.01, 5.0},
      Bound{"plane_max_deviation", config.plane_max_deviation, 1e-3, 1.0},
      Bound{"match_spacing", config.match_spacing, 0.02, 10.0},
      Bound{"insert_spacing", config.insert_spacing, 0.02, 10.0},
      Bound{"fine_resolution", config.fine_resolution, 0.05, 10.0},
      Bound{"coarse_resolution", config.coarse_resolution, 0.05, 30.0},
      Bound{"coarse_noise", config.coarse_noise, 0.0, 10.0},
      Bound{"map_radius", config.map_radius, config.max_range, 2000.0},
      Bound{"max_map_windows", static_cast<double>(config.max_map_windows), 1e4, 1e8},
      Bound{"keyframe_distance", config.keyframe_distance, 0.0, 10.0},
      Bound{"keyframe_angle", config.keyframe_angle, 0.0, 3.2},
      Bound{"linear_acceleration", config.linear_acceleration, 1e-3, 1000.0},
      Bound{"angular_acceleration", config.angular_acceleration, 1e-3, 1000.0},
      Bound{"initial_speed", config.initial_speed, 1e-3, 1000.0},
      Bound{"initial_turn_rate", config.initial_turn_rate, 1e-3, 100.0},
      Bound{"map_distortion_speed", config.map_distortion_speed, 1e-3, 100.0},
      Bound{"map_distortion_turn_rate", config.map_distortion_turn_rate, 1e-3, 100.0},
      Bound{"gyro_noise", config.gyro_noise, 1e-5, 10.0},
      Bound{"wheel_speed_noise", config.wheel_speed_noise, 1e-4, 100.0},
      Bound{"wheel_yaw_noise", config.wheel_yaw_noise, 1e-4, 100.0},
      Bound{"max_iterations", static_cast<double>(config.max_iterations), 1, 100},
      Bound{"edge_noise", config.edge_noise, 1e-3, 10.0},
      Bound{"min_inlier_fraction", config.min_inlier_fraction, 0.0, 1.0},
      Bound{"min_matches", static_cast<double>(config.min_matches), 6, 1e6},
      Bound{"lost_scans_before_restart", static_cast<double>(config.lost_scans_before_restart), 1, 1e6},
      Bound{"information_deflation", config.information_deflation, 1.0, 1e6},
      Bound{"drift_share", config.drift_share, 0.0, 1e3},
      Bound{"drift_translation", config.drift_translation, 0.0, 10.0},
      Bound{"drift_rotation", config.drift_rotation, 0.0, 1.0},
  };
}

}  // namespace

Status LoamConfig::validate() const {
  for (const Bound& bound : bounds_of(*this)) {
    if (!(bound.value >= bound.low && bound.value <= bound.high)) {
      return failure(std::string("odometry.") + bound.field + ": must be " + std::to_string(bound.low) +
                     " to " + std::to_string(bound.high) + ", is " + std::to_string(bound.value));
    }
  }
  if (!(min_range < max_range)) return failure("odometry.min_range: must be less than max_range");
  if (!(coarse_resolution > fine_resolution)) {
    return failure("odometry.coarse_resolution: must be greater than fine_resolution");
  }
  if (!all_finite(T_base_lidar) || std::abs(T_base_lidar.linear().determinant() - 1.0) > 1e-3) {
    return failure("odometry.T_base_lidar: must be a rigid transform");
  }
  if (!(std::abs(q_base_imu.norm() - 1.0) < 1e-3))
    return failure("odometry.q_base_imu: must be a unit quaternion");
  return {};
}

}  // namespace fleetmap::odometry
