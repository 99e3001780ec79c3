#include "sim/lane_drive.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fleetmap::testing {
namespace {

constexpr double kPi = std::numbers::pi;

/// From rest to rest over `distance`, at most at `rate`.
template <class Visit>
void ramp(double distance, double rate, double acceleration, Visit visit) {
  double speed = 0.0, done = 0.0;
  while (done < distance - 1e-9) {
    const double brake = std::sqrt(2.0 * acceleration * (distance - done));
    speed = std::min({speed + acceleration * LaneDrive::kStep, rate, std::max(brake, 1e-3)});
    done = std::min(distance, done + speed * LaneDrive::kStep);
    visit(done);
  }
}

}  // namespace

LaneDrive::LaneDrive(const sim::World& world, const DriveCondition& how, double length, std::uint64_t seed)
    : world_(world), how_(how), random_(seed) {
  std::uniform_real_distribution<double> phase(0.0, 2.0 * kPi);
  for (double& p : phases_) p = phase(random_);
  const auto& lanes = world.aisles();
  std::size_t lane = seed % std::max<std::size_t>(1, lanes.size() / 2);
  std::vector<Eigen::Vector2d> path;
  for (double way = 0.0; way < length && lane < lanes.size(); ++lane) {
    const Eigen::Vector2d along = lanes[lane].to - lanes[lane].from;
    const bool out = path.size() % 4 == 0;
    const Eigen::Vector2d begin = lanes[lane].from + (0.98 - how.lane_share) * along,
                          end = lanes[lane].to - 0.02 * along;
    path.push_back(out ? begin : end);
    path.push_back(out ? end : begin);
    way += how.lane_share * along.norm();
  }
  follow(path);
}

Pose LaneDrive::base(std::size_t step) const {
  return on_ground(planar_[std::min(step, planar_.size() - 1)]);
}

Pose LaneDrive::shaken(std::size_t step) const {
  if (how_.shake <= 0.0) return Pose::Identity();
  const double a = 2.0 * kPi * how_.shake * LaneDrive::kStep * static_cast<double>(step);
  const Eigen::Vector3d way(std::sin(a + phases_[0]), std::sin(1.1 * a + phases_[1]),
                            0.5 * std::sin(0.9 * a + phases_[2]));
  const Eigen::Vector3d turn(std::sin(1.05 * a + phases_[3]), std::sin(a + phases_[4]),
                             0.5 * std::sin(0.95 * a + phases_[5]));
  Vector6d d;
  d << how_.shake_way * way, how_.shake_angle * turn;
  return se3_exp(d);
}

/// Straight to each corner, with a stop of a second at the start; corners are turned on the spot.
void LaneDrive::follow(const std::vector<Eigen::Vector2d>& path) {
  const double acceleration = std::max(1.0, how_.speed), angular = 5.0;
  const auto toward = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return std::atan2(b.y() - a.y(), b.x() - a.x());
  };
  Planar now{path[0], toward(path[0], path[1]), 0.0};
  for (double t = 0.0; t < 1.0; t += LaneDrive::kStep) planar_.push_back(now);
  for (std::size_t corner = 1; corner < path.size(); ++corner) {
    const double turn = wrap_angle(toward(now.at, path[corner]) - now.yaw);
    const double begin = now.yaw;
    ramp(std::abs(turn), how_.turn_rate, angular, [&](double done) {
      now.yaw = begin + std::copysign(done, turn);
      planar_.push_back(now);
    });
    const Eigen::Vector2d from = now.at, direction = (path[corner] - from).normalized();
    const double way = now.way;
    ramp((path[corner] - from).norm(), how_.speed, acceleration, [&](double done) {
      now.at = from + done * direction;
      now.way = way + done;
      planar_.push_back(now);
    });
  }
}

Pose LaneDrive::on_ground(const Planar& p) const {
  const Eigen::Vector2d ahead(std::cos(p.yaw), std::sin(p.yaw)), left(-ahead.y(), ahead.x());
  constexpr double kHalf = 0.3;  // m, half of a wheelbase
  const auto height = [&](const Eigen::Vector2d& at) { return world_.ground_height(at); };
  const double pitch = -std::atan2(height(p.at + kHalf * ahead) - height(p.at - kHalf * ahead), 2 * kHalf);
  const double roll = std::atan2(height(p.at + kHalf * left) - height(p.at - kHalf * left), 2 * kHalf);
  const double bump_pitch = how_.tilt * (std::sin(2 * kPi * p.way / 3.1 + phases_[6]) +
                                         0.5 * std::sin(2 * kPi * p.way / 1.3 + phases_[7]));
  const double bump_roll =
      0.6 * how_.tilt *
      (std::sin(2 * kPi * p.way / 2.3 + phases_[8]) + 0.5 * std::sin(2 * kPi * p.way / 0.9 + phases_[9]));
  return make_pose(rotation_from_rpy(roll + bump_roll, pitch + bump_pitch, p.yaw),
                   {p.at.x(), p.at.y(), height(p.at) + 0.1});
}

}  // namespace fleetmap::testing
