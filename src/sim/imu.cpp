#include "fleetmap/sim/imu.hpp"

#include "gaussian.hpp"
#include "spec_rules.hpp"

namespace fleetmap::sim {
namespace {

Eigen::Vector3d normal3(RandomStream& random) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return {x, y, z};
}

}  // namespace

struct ImuModel::State {
  State(const ImuSpec& s, std::uint64_t seed)
      : spec(s), random(seed, 0x1470), heading(s.heading_sigma, s.heading_correlation_time) {
    gyro_bias = spec.gyro_bias_sigma * normal3(random);
    accel_bias = spec.accel_bias_sigma * normal3(random);
  }
  ImuSpec spec;
  RandomStream random;
  GaussMarkov heading;
  Eigen::Vector3d gyro_bias, accel_bias;
};

ImuModel::ImuModel(const ImuSpec& spec, std::uint64_t seed) : state_(std::make_unique<State>(spec, seed)) {}
ImuModel::~ImuModel() = default;
ImuModel::ImuModel(ImuModel&&) noexcept = default;

sensor::Imu ImuModel::measure(const ImuMotion& before, const ImuMotion& now) {
  State& s = *state_;
  const double dt = std::max(to_seconds(now.stamp - before.stamp), 1e-6);
  const double root_dt = std::sqrt(dt);
  s.gyro_bias += s.spec.gyro_bias_walk * root_dt * normal3(s.random);
  s.accel_bias += s.spec.accel_bias_walk * root_dt * normal3(s.random);

  sensor::Imu imu;
  imu.stamp = now.stamp;
  const Eigen::Matrix3d R_before = before.T_enu_imu.linear(), R_now = now.T_enu_imu.linear();
  const Eigen::Vector3d turn = so3_log(R_before.transpose() * R_now);
  const Eigen::Vector3d force =
      (now.velocity_enu - before.velocity_enu) / dt + Eigen::Vector3d(0.0, 0.0, s.spec.gravity);
  const Eigen::Matrix3d R_middle = R_before * so3_exp(0.5 * turn);
  imu.angular_velocity = turn / dt + s.gyro_bias + s.spec.gyro_noise / root_dt * normal3(s.random);
  imu.specific_force =
      R_middle.transpose() * force + s.accel_bias + s.spec.accel_noise / root_dt * normal3(s.random);

  const Eigen::Vector3d tilt = s.spec.tilt_sigma * normal3(s.random);
  const double heading = s.heading.next(dt, s.random);
  if (s.spec.reports_orientation) {
    imu.q_enu_imu = Eigen::Quaterniond(so3_exp({tilt.x(), tilt.y(), heading}) * R_now).normalized();
    const double tilt_variance = s.spec.tilt_sigma * s.spec.tilt_sigma;
    imu.orientation_variance = {tilt_variance, tilt_variance, s.spec.heading_sigma * s.spec.heading_sigma};
  }
  return imu;
}

}  // namespace fleetmap::sim
