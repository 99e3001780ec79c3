#include "fleetmap/sim/vehicle.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "spec_rules.hpp"

namespace fleetmap::sim {
namespace {

constexpr double kMaxStationarySpeed = 0.02;  // m/s

double towards(double value, double target, double max_change) {
  return value + std::clamp(target - value, -max_change, max_change);
}

}  // namespace

/// The target's own rate passes through the damper, so that the body does not lag behind on a slope.
void Vehicle::Spring::follow(double next_target, double stiffness, double damping, double dt) {
  const double target_rate = (next_target - target) / dt;
  target = next_target;
  rate += dt * (stiffness * (target - value) + damping * (target_rate - rate));
  value += dt * rate;
}

Vehicle::Vehicle(const VehicleSpec& spec, std::shared_ptr<const World> world, const Eigen::Vector2d& p,
                 double yaw)
    : spec_(spec), world_(std::move(world)), p_(p), yaw_(yaw), battery_wh_(spec.battery_wh) {
  const Eigen::Vector3d under = ground();
  height_ = {under.x(), 0.0, under.x()};
  slope_east_ = {under.y(), 0.0, under.y()};
  slope_north_ = {under.z(), 0.0, under.z()};
  update_suspension(1e-3);
}

/// Height (m) and slope towards east and north of the ground under the wheels.
Eigen::Vector3d Vehicle::ground() const {
  const double half = 0.5 * spec_.wheelbase;
  const Eigen::Vector2d forward(half * std::cos(yaw_), half * std::sin(yaw_)),
      left(-forward.y(), forward.x());
  double height = 0.0;
  for (const double f : {-1.0, 1.0}) {
    for (const double l : {-1.0, 1.0}) height += 0.25 * world_->ground_height(p_ + f * forward + l * left);
  }
  const Eigen::Vector3d normal = world_->ground_normal(p_);
  const double up = std::max(normal.z(), 0.2);
  return {height, -normal.x() / up, -normal.y() / up};
}

void Vehicle::step(double forward_speed, double yaw_rate, double dt) {
  if (!(dt > 0.0)) return;
  const bool powered = battery_wh_ > 0.0 && std::isfinite(forward_speed) && std::isfinite(yaw_rate);
  drive(powered ? forward_speed : 0.0, powered ? yaw_rate : 0.0, dt);
  yaw_ = wrap_angle(yaw_ + 0.5 * yaw_rate_ * dt);
  move(powered ? forward_speed : 0.0, dt);
  yaw_ = wrap_angle(yaw_ + 0.5 * yaw_rate_ * dt);
  update_suspension(dt);
  const double joule = (spec_.idle_power_w + spec_.energy_per_metre * std::abs(speed_) +
                        spec_.energy_per_radian * std::abs(yaw_rate_)) *
                       dt;
  battery_wh_ = std::max(0.0, battery_wh_ - joule / 3600.0);
}

/// Motors: a first-order lag behind the command, then limited accelerations.
void Vehicle::drive(double forward_speed, double yaw_rate, double dt) {
  const double share = dt / (dt + spec_.lag);
  commanded_speed_ +=
      share * (std::clamp(forward_speed, -spec_.max_speed, spec_.max_speed) - commanded_speed_);
  commanded_yaw_rate_ +=
      share * (std::clamp(yaw_rate, -spec_.max_yaw_rate, spec_.max_yaw_rate) - commanded_yaw_rate_);
  speed_ = towards(speed_, commanded_speed_, spec_.acceleration * dt);
  yaw_rate_ = towards(yaw_rate_, commanded_yaw_rate_, spec_.yaw_acceleration * dt);
}

/// The pose after `distance` m (negative: back) along the present arc.
Eigen::Vector2d Vehicle::ahead(double distance) const {
  const double turn = std::abs(speed_) > 0.1 ? 0.5 * yaw_rate_ / speed_ * distance : 0.0;
  const Eigen::Vector2d slope(slope_east_.value, slope_north_.value);
  const Eigen::Vector2d heading(std::cos(yaw_ + turn), std::sin(yaw_ + turn));
  return p_ + distance / std::sqrt(1.0 + std::pow(slope.dot(heading), 2)) * heading;
}

/// Brakes hard for an obstacle within the braking distance, so that the robot stops before it.
void Vehicle::move(double wanted, double dt) {
  const double way = speed_ < 0.0 ? -1.0 : 1.0;
  const double reach = 0.5 * speed_ * speed_ / spec_.braking + 2.0 * std::abs(speed_) * dt;
  bool in_the_way = world_->blocked(ahead(way * reach), spec_.radius);
  if (in_the_way && world_->blocked(p_, spec_.radius)) {  // backing off must be possible
    in_the_way = world_->clearance(ahead(way * (reach + 0.1)), 2.0 * spec_.radius) <
                 world_->clearance(p_, 2.0 * spec_.radius);
  }
  if (in_the_way) {
    const double before = std::abs(speed_);
    speed_ = way * std::max(0.0, before - (spec_.braking + spec_.acceleration) * dt);
    if (world_->blocked(ahead(speed_ * dt), spec_.radius)) speed_ = 0.0;
  }
  touching_ = (in_the_way && std::abs(speed_) < kMaxStationarySpeed) || (touching_ && wanted == 0.0);
  const Eigen::Vector2d next = ahead(speed_ * dt);
  odometer_ += std::abs(speed_) * dt;
  p_ = next;
}

/// The body on its tyres.
void Vehicle::update_suspension(double dt) {
  const double omega = 2.0 * std::numbers::pi * spec_.suspension_rate;
  const double stiffness = omega * omega, damping = 2.0 * spec_.suspension_damping * omega;
  const Eigen::Vector3d under = ground();
  height_.follow(under.x(), stiffness, damping, dt);
  slope_east_.follow(under.y(), stiffness, damping, dt);
  slope_north_.follow(under.z(), stiffness, damping, dt);
  const Eigen::Vector3d up = Eigen::Vector3d(-slope_east_.value, -slope_north_.value, 1.0).normalized();
  const Eigen::Vector3d left = up.cross(Eigen::Vector3d(std::cos(yaw_), std::sin(yaw_), 0.0)).normalized();
  Eigen::Matrix3d R;
  R << left.cross(up), left, up;
  const Eigen::Vector3d foot(p_.x(), p_.y(), height_.value);
  T_enu_base_ = make_pose(R, foot + spec_.base_height * up);
}

}  // namespace fleetmap::sim
