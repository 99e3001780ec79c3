#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/sensor/samples.hpp"

namespace fleetmap::sim {

struct ImuSpec {
  double rate = 100.0;             ///< Hz
  double gyro_noise = 1e-3;        ///< rad/s/sqrt(Hz)
  double accel_noise = 1e-2;       ///< m/s^2/sqrt(Hz)
  double gyro_bias_sigma = 3e-3;   ///< rad/s, at start
  double accel_bias_sigma = 5e-2;  ///< m/s^2, at start
  double gyro_bias_walk = 2e-5;    ///< rad/s/sqrt(s)
  double accel_bias_walk = 2e-4;   ///< m/s^2/sqrt(s)
  double gravity = 9.80665;        ///< m/s^2
  bool reports_orientation = true;
  double tilt_sigma = 0.01;                 ///< rad, of each orientation, white
  double heading_sigma = 0.05;              ///< rad, of the magnetic heading, drifting slowly
  double heading_correlation_time = 120.0;  ///< s
  Status validate() const;
};

/// The truth of an IMU at one moment.
struct ImuMotion {
  Stamp stamp;
  Pose T_enu_imu = Pose::Identity();
  Eigen::Vector3d velocity_enu = Eigen::Vector3d::Zero();  ///< m/s
};

/// Gyroscopes and accelerometers with bias random walk and white noise; each sample is the mean over the time
/// since the sample before, as devices integrate it. Deterministic in `seed`.
class ImuModel {
 public:
  ImuModel(const ImuSpec& spec, std::uint64_t seed);
  ~ImuModel();
  ImuModel(ImuModel&&) noexcept;
  /// What the device says at now.stamp of the motion since `before`, which must be earlier.
  sensor::Imu measure(const ImuMotion& before, const ImuMotion& now);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fleetmap::sim
