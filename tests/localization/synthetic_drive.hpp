#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "fleetmap/localization/ekf.hpp"

namespace fleetmap::localization::testing {

inline const GeoPoint kSite{0.8554, 0.1470, 112.0};

Stamp at_time(double seconds);

struct Truth {
  Eigen::Vector3d p;  ///< m, ENU at kSite
  Eigen::Vector3d v;
  Eigen::Matrix3d R;
  double speed = 0.0;
};

/// A robot that drives curves over gentle slopes at about 1.5 m/s without sliding; integrated at 1 kHz.
class Drive {
 public:
  using Profile = std::function<double(double)>;
  explicit Drive(double duration, double yaw0 = 0.7);
  Drive(double duration, double yaw0, const Profile& speed, const Profile& turn);
  const Truth& at(double t) const { return states_[index(t)]; }
  Eigen::Vector3d angular_velocity(double t) const;
  Eigen::Vector3d specific_force(double t) const;

 private:
  static constexpr double kStep = 1e-3;
  static std::size_t index(double t);
  std::vector<Truth> states_;
};

/// Sensors of a robot on a drive. Everything is drawn from `seed` alone.
struct Sensors {
  unsigned seed = 1;
  double imu_rate = 100.0;
  double wheel_rate = 20.0;
  double gps_rate = 5.0;
  double gyro_noise = 2e-3;   ///< rad/s/sqrt(Hz)
  double accel_noise = 2e-2;  ///< m/s^2/sqrt(Hz)
  double gyro_bias_sigma = 5e-3;
  double accel_bias_sigma = 0.05;
  double wheel_sigma = 0.05;
  double wheel_yaw_rate_sigma = 0.02;
  double gps_sigma = 1.0;
  double gps_time = 0.0;  ///< s, correlation time; 0 is white
  bool imu = true;
  bool wheel = true;
  bool gps = true;
  bool yaw_rate = true;
  Mounting mounting;
  double imu_yaw_error = 0.0;
  bool imu_orientation = false;
  std::function<void(double, sensor::Fix&)> spoil_fix;
  std::function<bool(double)> gps_out;

  std::vector<Sample> measure(const Drive& drive, double duration) const;
};

bool add(Ekf& ekf, const Sample& sample);

struct PoseError {
  Eigen::Vector3d position;  ///< m, ENU
  Eigen::Vector3d rotation;  ///< rad, ENU axes
  double nees = 0.0;         ///< of all six
  double nees_horizontal = 0.0;
  double horizontal() const { return position.head<2>().norm(); }
};

PoseError error_of(const GlobalPose& G, const Truth& truth);

}  // namespace fleetmap::localization::testing
