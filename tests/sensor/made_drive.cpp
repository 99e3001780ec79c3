#include "made_drive.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include "fleetmap/geometry/degree.hpp"
#include "fleetmap/geometry/geodesy.hpp"

namespace fleetmap::sensor {
namespace {

constexpr double kStep = 1e-3;  // s
constexpr double kGravity = 9.80665;
constexpr double kGpsTime = 60.0, kSlipTime = 0.5;  // s
constexpr double kMargin = 1.0;                     // s before the first and after the last scan

/// The motion of the wheels' base_link.
class Motion {
 public:
  explicit Motion(const MadeDriveOptions& options) : options_(options) {
    const auto steps = static_cast<std::size_t>((options.seconds + 2.0 * kMargin) / kStep);
    double x = 0.0, y = 0.0;
    double yaw = 0.0;
    for (std::size_t k = 0; k < steps; ++k) {
      const double t = static_cast<double>(k) * kStep;
      states_.push_back({x, y, yaw});
      const double middle = yaw + 0.5 * kStep * turn_rate(t + 0.5 * kStep);
      x += kStep * speed(t + 0.5 * kStep) * std::cos(middle);
      y += kStep * speed(t + 0.5 * kStep) * std::sin(middle);
      yaw += kStep * turn_rate(t + 0.5 * kStep);
    }
  }
  static double speed(double t) { return 1.0 + 0.4 * std::sin(t) * std::sin(0.13 * t); }
  double turn_rate(double t) const { return options_.turn_rate * std::tanh(3.0 * std::sin(0.28 * t)); }
  Pose at(double t) const {
    const auto k = static_cast<std::size_t>(std::lround(t / kStep));
    const Eigen::Vector3d state = states_.at(k);
    const double roll = options_.sway * std::sin(4.1 * t) * std::sin(0.4 * t);
    const double pitch = options_.sway * std::sin(2.9 * t + 1.0) * std::cos(0.3 * t);
    return make_pose(rotation_from_rpy(roll, pitch, state.z()), Eigen::Vector3d(state.x(), state.y(), 0.0));
  }

 private:
  MadeDriveOptions options_;
  std::vector<Eigen::Vector3d> states_;
};

class Maker {
 public:
  Maker(std::uint64_t seed, const MadeDriveOptions& options)
      : options_(options), motion_(options), random_(seed) {
    made_.T_base_imu = make_pose(Eigen::Quaterniond(normal(), normal(), normal(), normal()).normalized(),
                                 Eigen::Vector3d(0.3 * normal(), 0.3 * normal(), 0.1 * normal()));
    made_.imu_delay = 0.03 * normal();
    made_.p_base_antenna = {0.4 * normal(), 0.4 * normal(), 0.3};
    made_.gps_delay = 0.05 * normal();
    made_.T_wheels_base = make_pose(
        rotation_from_rpy(2.0 * kDegree * normal(), 2.0 * kDegree * normal(), 10.0 * kDegree * normal()),
        Eigen::Vector3d(0.2 * normal(), 0.1 * normal(), 0.0));
    made_.speed_scale = 1.0 + 0.02 * normal();
  }

  MadeDrive make() {
    const Eigen::Vector3d gyro_bias = 3e-3 * vector(), accel_bias = 0.05 * vector();
    for (double t = kMargin; t < kMargin + options_.seconds; t += 0.1) add_scan(t);
    for (double t = 0.5; t < options_.seconds + 1.5; t += 0.01) add_imu(t, gyro_bias, accel_bias);
    for (double t = 0.5; t < options_.seconds + 1.5; t += 0.2) add_fix(t);
    for (double t = 0.5; t < options_.seconds + 1.5; t += 0.05) add_wheel(t);
    return std::move(made_);
  }

 private:
  double normal() { return normal_(random_); }
  Eigen::Vector3d vector() { return {normal(), normal(), normal()}; }
  static Stamp stamp_of(double t) { return stamp_from_ns(1'750'000'000'000'000'000) + from_seconds(t); }
  Pose T_world_base(double t) const { return motion_.at(t) * made_.T_wheels_base; }

  void add_scan(double t) {
    if (made_.drive.track.empty()) T_odom_world_ = T_world_base(t).inverse();
    Vector6d noise;
    noise << 5e-3 * vector(), 5e-4 * vector();
    made_.drive.track.push_back({stamp_of(t), T_odom_world_ * T_world_base(t) * se3_exp(noise)});
  }
  void add_imu(double t, const Eigen::Vector3d& gyro_bias, const Eigen::Vector3d& accel_bias) {
    constexpr double kApart = 5.0 * kStep;
    const Pose before = T_world_base(t - kApart) * made_.T_base_imu, now = T_world_base(t) * made_.T_base_imu,
               after = T_world_base(t + kApart) * made_.T_base_imu;
    const Eigen::Vector3d acceleration =
        (after.translation() - 2.0 * now.translation() + before.translation()) / (kApart * kApart);
    Imu imu;
    imu.stamp = stamp_of(t + made_.imu_delay);
    imu.angular_velocity =
        so3_log(before.linear().transpose() * after.linear()) / (2.0 * kApart) + gyro_bias + 0.01 * vector();
    imu.specific_force = now.linear().transpose() * (acceleration + kGravity * Eigen::Vector3d::UnitZ()) +
                         accel_bias + 0.1 * vector();
    made_.drive.imu.push_back(imu);
  }
  void add_fix(double t) {
    const double keep = std::exp(-0.2 / kGpsTime);
    slow_ = keep * slow_ + options_.gps_slow * std::sqrt(1.0 - keep * keep) * vector();
    const Pose T_enu_world = make_pose(rotation_from_rpy(0.01, -0.02, 1.0), Eigen::Vector3d(20.0, -5.0, 1.0));
    Fix fix;
    fix.stamp = stamp_of(t + made_.gps_delay);
    fix.position = site_.to_geo(T_enu_world * T_world_base(t) * made_.p_base_antenna + slow_ +
                                options_.gps_white * vector());
    made_.drive.fixes.push_back(fix);
  }
  void add_wheel(double t) {
    const double keep = std::exp(-0.05 / kSlipTime);
    slip_ = keep * slip_ + 0.02 * std::sqrt(1.0 - keep * keep) * normal();
    Wheel wheel;
    wheel.stamp = stamp_of(t);
    wheel.forward_speed = Motion::speed(t) * made_.speed_scale * (1.0 + slip_) + 0.01 * normal();
    made_.drive.wheels.push_back(wheel);
  }

  MadeDriveOptions options_;
  Motion motion_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  LocalFrame site_{geo_point_from_degrees(48.2, 11.6, 500.0)};
  Pose T_odom_world_ = Pose::Identity();
  Eigen::Vector3d slow_ = Eigen::Vector3d::Zero();
  double slip_ = 0.0;
  MadeDrive made_;
};

}  // namespace

MadeDrive made_drive(std::uint64_t seed, const MadeDriveOptions& options) {
  return Maker(seed, options).make();
}

}  // namespace fleetmap::sensor
