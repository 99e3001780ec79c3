#include "inertial_motion.hpp"

#include <algorithm>
#include <iterator>

namespace fleetmap::sensor {
namespace {

constexpr Duration kMaxGap = std::chrono::milliseconds(250);

struct Rates {
  Eigen::Vector3d turn, force;
};

Rates between(const Imu& before, const Imu& after, Stamp at) {
  const double share = to_seconds(at - before.stamp) / to_seconds(after.stamp - before.stamp);
  return {before.angular_velocity + share * (after.angular_velocity - before.angular_velocity),
          before.specific_force + share * (after.specific_force - before.specific_force)};
}

InertialMotion step_of(const Rates& mean, double dt) {
  const Eigen::Matrix3d half = so3_exp(0.5 * dt * mean.turn);
  InertialMotion step;
  step.seconds = dt;
  step.R_begin_end = half * half;
  step.velocity_by_bias = dt * half;
  step.displacement_by_bias = 0.5 * dt * step.velocity_by_bias;
  step.velocity = step.velocity_by_bias * mean.force;
  step.displacement = step.displacement_by_bias * mean.force;
  return step;
}

}  // namespace

InertialMotion InertialMotion::followed_by(const InertialMotion& then) const {
  InertialMotion all;
  all.seconds = seconds + then.seconds;
  all.R_begin_end = R_begin_end * then.R_begin_end;
  all.velocity = velocity + R_begin_end * then.velocity;
  all.displacement = displacement + then.seconds * velocity + R_begin_end * then.displacement;
  all.velocity_by_bias = velocity_by_bias + R_begin_end * then.velocity_by_bias;
  all.displacement_by_bias =
      displacement_by_bias + then.seconds * velocity_by_bias + R_begin_end * then.displacement_by_bias;
  return all;
}

std::optional<InertialMotion> integrate(const std::vector<Imu>& imu, Stamp begin, Stamp end,
                                        const Eigen::Vector3d& gyro_bias) {
  auto after = std::ranges::upper_bound(imu, begin, {}, &Imu::stamp);
  if (after == imu.begin() || imu.empty() || imu.back().stamp < end) return std::nullopt;
  InertialMotion motion;
  for (Stamp at = begin; at < end; ++after) {
    const Imu& before = *std::prev(after);
    if (after == imu.end() || after->stamp - before.stamp > kMaxGap) return std::nullopt;
    const Stamp until = std::min(end, after->stamp);
    const Rates first = between(before, *after, at), last = between(before, *after, until);
    const Rates mean{0.5 * (first.turn + last.turn) - gyro_bias, 0.5 * (first.force + last.force)};
    motion = motion.followed_by(step_of(mean, to_seconds(until - at)));
    at = until;
  }
  return motion;
}

}  // namespace fleetmap::sensor
