#include "support/synthetic_lidar.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace fleetmap::testing {
namespace {

constexpr double kTile = 4.0;  // m
constexpr double kPi = std::numbers::pi;

std::int64_t tile_of(double value) { return static_cast<std::int64_t>(std::floor(value / kTile)); }

/// Distance at which the ray enters the box |p| <= h, or infinity; from inside, where it leaves.
double cast_box(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, const Eigen::Vector3d& h) {
  double near = -std::numeric_limits<double>::infinity(), far = -near;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(direction[axis]) < 1e-12) {
      if (std::abs(origin[axis]) > h[axis]) return std::numeric_limits<double>::infinity();
      continue;
    }
    const double a = (-h[axis] - origin[axis]) / direction[axis],
                 b = (h[axis] - origin[axis]) / direction[axis];
    near = std::max(near, std::min(a, b));
    far = std::min(far, std::max(a, b));
  }
  if (near > far || far < 0.0) return std::numeric_limits<double>::infinity();
  return near > 0.0 ? near : far;
}

double cast_post(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                 const Eigen::Vector2d& position, double radius, double height) {
  const Eigen::Vector2d d = direction.head<2>(), o = origin.head<2>() - position;
  const double a = d.squaredNorm(), b = o.dot(d), c = o.squaredNorm() - radius * radius;
  const double discriminant = b * b - a * c;
  if (a < 1e-12 || discriminant < 0.0) return std::numeric_limits<double>::infinity();
  const double distance = (-b - std::sqrt(discriminant)) / a;
  const double z = origin.z() + distance * direction.z();
  return distance > 0.0 && z >= 0.0 && z <= height ? distance : std::numeric_limits<double>::infinity();
}

}  // namespace

void SyntheticWorld::add_box(const Pose& T_world_box, const Eigen::Vector3d& half_extent) {
  const Eigen::Vector3d reach = T_world_box.linear().cwiseAbs() * half_extent;
  const Eigen::Vector2d center = T_world_box.translation().head<2>();
  boxes_.push_back({T_world_box.inverse(), half_extent});
  register_area(center - reach.head<2>(), center + reach.head<2>(), true,
                static_cast<std::uint32_t>(boxes_.size() - 1));
}

void SyntheticWorld::add_post(const Eigen::Vector2d& position, double radius, double height) {
  posts_.push_back({position, radius, height});
  register_area(position.array() - radius, position.array() + radius, false,
                static_cast<std::uint32_t>(posts_.size() - 1));
}

void SyntheticWorld::register_area(const Eigen::Vector2d& low, const Eigen::Vector2d& high, bool box,
                                   std::uint32_t index) {
  for (std::int64_t x = tile_of(low.x()); x <= tile_of(high.x()); ++x) {
    for (std::int64_t y = tile_of(low.y()); y <= tile_of(high.y()); ++y) {
      Tile& tile = tiles_[tile_key(x, y)];
      (box ? tile.boxes : tile.posts).push_back(index);
    }
  }
}

/// Steps that the ground cannot cross (sphere tracing), until within a tenth of a millimetre of it.
double SyntheticWorld::cast_ground(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                   double max_range) const {
  if (!ground_.height)
    return direction.z() < 0.0 && origin.z() > 0.0 ? std::min(max_range, -origin.z() / direction.z())
                                                   : max_range;
  const double closing = ground_.max_slope * direction.head<2>().norm() - direction.z();
  if (closing <= 0.0) return max_range;
  double range = 0.0;
  while (range < max_range) {
    const Eigen::Vector3d at = origin + range * direction;
    const double above = at.z() - ground_.height(at.x(), at.y());
    if (above < 1e-4) return range;
    range += above / closing;
  }
  return max_range;
}

/// Walks the tiles under the ray (Amanatides and Woo) until what it hit lies before the next tile.
std::optional<double> SyntheticWorld::cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                           double max_range) const {
  double best = cast_ground(origin, direction, max_range);
  std::int64_t tile[2] = {tile_of(origin.x()), tile_of(origin.y())};
  double next[2], step[2];
  for (int axis = 0; axis < 2; ++axis) {
    const double d = direction[axis];
    step[axis] = std::abs(d) < 1e-12 ? std::numeric_limits<double>::infinity() : kTile / std::abs(d);
    const double border = static_cast<double>(tile[axis] + (d > 0.0 ? 1 : 0)) * kTile;
    next[axis] = std::abs(d) < 1e-12 ? std::numeric_limits<double>::infinity() : (border - origin[axis]) / d;
  }
  for (double entered = 0.0; entered < best;) {
    if (const auto it = tiles_.find(tile_key(tile[0], tile[1])); it != tiles_.end()) {
      for (const std::uint32_t i : it->second.boxes) {
        const Box& box = boxes_[i];
        best = std::min(
            best, cast_box(box.T_box_world * origin, box.T_box_world.linear() * direction, box.half_extent));
      }
      for (const std::uint32_t i : it->second.posts) {
        best = std::min(best,
                        cast_post(origin, direction, posts_[i].position, posts_[i].radius, posts_[i].height));
      }
    }
    const int axis = next[0] < next[1] ? 0 : 1;
    entered = next[axis];
    next[axis] += step[axis];
    tile[axis] += direction[axis] > 0.0 ? 1 : -1;
  }
  if (best >= max_range) return std::nullopt;
  return best;
}

SyntheticWorld yard_world() {
  SyntheticWorld world;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  auto box = [&](double x, double y, double z, double yaw, double tilt, const Eigen::Vector3d& half) {
    world.add_box(make_pose(rotation_from_rpy(0.0, tilt, yaw), {x, y, z}), half);
  };
  for (int i = 0; i < 6; ++i) {  // houses on both sides, set back by different amounts
    const double x = -10.0 + 12.0 * i;
    box(x, 15.0 + 2.0 * unit(random), 3.0, 0.15 * (unit(random) - 0.5), 0.0, {4.0, 3.0, 3.0});
    box(x + 5.0, -16.0 - 2.0 * unit(random), 2.5, 0.3 * (unit(random) - 0.5), 0.0, {3.5, 3.0, 2.5});
  }
  box(58.0, 0.0, 3.0, 0.1, 0.0, {2.0, 9.0, 3.0});
  box(-18.0, 2.0, 2.0, -0.05, 0.0, {1.0, 8.0, 2.0});
  for (int i = 0; i < 14; ++i) {  // crates and boards
    const double side = i % 2 == 0 ? 9.5 : -9.5;
    box(-6.0 + 4.1 * i, side, 0.6, kPi * unit(random), 0.0, {0.4 + 0.5 * unit(random), 0.5, 0.6});
    box(-4.0 + 4.3 * i, -side * 1.05, 1.0, side > 0 ? 1.4 : -1.5, 0.5, {0.9, 0.8, 0.04});
  }
  for (int i = 0; i < 16; ++i) {
    world.add_post({-8.0 + 3.7 * i, (i % 2 == 0 ? 1.0 : -1.0) * (8.2 + unit(random))},
                   0.06 + 0.06 * unit(random), 4.0);
  }
  return world;
}

SyntheticWorld panel_world() {
  SyntheticWorld world;
  for (int row = -4; row < 4; ++row) {
    const double y = 6.0 * row + 3.0;
    for (int table = 0; table < 10; ++table) {
      const double x = -45.0 + 10.0 * table;
      world.add_box(make_pose(rotation_from_rpy(0.44, 0.0, 0.0), {x, y, 1.5}), {4.8, 1.5, 0.02});
      for (const double dx : {-3.6, -1.2, 1.2, 3.6}) world.add_post({x + dx, y}, 0.06, 1.45);
    }
  }
  return world;
}

SyntheticWorld corridor_world() {
  SyntheticWorld world;
  for (const double y : {-4.5, 4.5}) {
    world.add_box(make_pose(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.0, y, 1.5)), {100.0, 0.5, 1.5});
  }
  return world;
}

sensor::Scan make_scan(const SyntheticWorld& world, const PoseAt& pose_at, double seconds,
                       const odometry::LidarModel& model, const ScanOptions& options) {
  std::mt19937_64 random(options.seed * 0x9e3779b97f4a7c15ull +
                         static_cast<std::uint64_t>(std::llround(seconds * 1e6)));
  std::normal_distribution<double> noise(0.0, options.noise);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  sensor::Scan scan;
  scan.stamp = stamp_from_ns(std::llround(seconds * 1e9));
  scan.has_time = options.has_time;
  scan.has_ring = options.has_ring && model.has_rings();
  auto fire = [&](const Pose& T_world_lidar, double azimuth, double elevation, double time,
                  std::size_t ring) {
    const Eigen::Vector3d direction(std::cos(elevation) * std::cos(azimuth),
                                    std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
    const auto range =
        world.cast(T_world_lidar.translation(), T_world_lidar.linear() * direction, options.max_range);
    if (!range || (options.keep < 1.0 && unit(random) > options.keep)) return;
    sensor::ScanPoint point;
    point.position = ((*range + noise(random)) * direction).cast<float>();
    point.intensity = static_cast<float>(std::min(100.0, 1000.0 / (10.0 + *range)));
    point.time = static_cast<float>(time);
    point.ring = static_cast<std::uint16_t>(ring);
    scan.points.push_back(point);
  };
  if (!model.has_rings()) {
    constexpr int kPoints = 24000;
    for (int i = 0; i < kPoints; ++i) {
      const double time = model.scan_period * i / kPoints, t = seconds + time;
      fire(pose_at(t) * options.T_base_lidar, 2.0 * kPi * std::fmod(27.31 * t, 1.0),
           0.4 + 0.52 * std::sin(2.0 * kPi * std::fmod(1013.7 * t, 1.0)) - 0.15, time, 0);
    }
    return scan;
  }
  for (int column = 0; column < model.columns; ++column) {
    const double turn = static_cast<double>(column) / model.columns, time = turn * model.scan_period;
    const Pose T_world_lidar = pose_at(seconds + time) * options.T_base_lidar;
    const double azimuth = kPi + (model.clockwise ? -2.0 : 2.0) * kPi * turn;
    for (std::size_t r = 0; r < model.vertical_angles.size(); ++r) {
      fire(T_world_lidar, azimuth, model.vertical_angles[r], time, r);
    }
  }
  return scan;
}

SyntheticDrive::SyntheticDrive(const std::vector<DriveLeg>& legs, double acceleration,
                               double yaw_acceleration, double sway)
    : sway_(sway), states_(1) {
  for (const DriveLeg& leg : legs) {
    const auto steps = static_cast<std::size_t>(leg.duration / step_);
    for (std::size_t i = 0; i < steps; ++i) {
      State s = states_.back();
      s.speed += std::clamp(leg.speed - s.speed, -acceleration * step_, acceleration * step_);
      s.yaw_rate +=
          std::clamp(leg.yaw_rate - s.yaw_rate, -yaw_acceleration * step_, yaw_acceleration * step_);
      const double middle = s.yaw + 0.5 * s.yaw_rate * step_;
      s.x += s.speed * step_ * std::cos(middle);
      s.y += s.speed * step_ * std::sin(middle);
      s.yaw += s.yaw_rate * step_;
      states_.push_back(s);
    }
  }
}

SyntheticDrive::State SyntheticDrive::state(double seconds) const {
  const double at = std::clamp(seconds / step_, 0.0, static_cast<double>(states_.size() - 1));
  const auto i = std::min(static_cast<std::size_t>(at), states_.size() - 2);
  const double alpha = at - static_cast<double>(i);
  auto mix = [&](double State::*field) {
    return (1.0 - alpha) * states_[i].*field + alpha * states_[i + 1].*field;
  };
  return {mix(&State::x), mix(&State::y), mix(&State::yaw), mix(&State::speed), mix(&State::yaw_rate)};
}

/// The chassis sways with the distance it has come, so it is still when the robot is.
Pose SyntheticDrive::at(double seconds) const {
  const State s = state(seconds);
  const double pitch = sway_ * std::sin(1.7 * s.x + 0.9 * s.y),
               roll = sway_ * std::sin(1.1 * s.x - 1.3 * s.y);
  return make_pose(rotation_from_rpy(roll, pitch, s.yaw), {s.x, s.y, 0.0});
}

double SyntheticDrive::speed(double seconds) const { return state(seconds).speed; }

sensor::Imu SyntheticDrive::imu(double seconds) const {
  constexpr double kStep = 1e-3;
  sensor::Imu imu;
  imu.stamp = stamp_from_ns(std::llround(seconds * 1e9));
  imu.angular_velocity =
      so3_log(at(seconds - kStep).linear().transpose() * at(seconds + kStep).linear()) / (2.0 * kStep);
  imu.specific_force = at(seconds).linear().transpose() * Eigen::Vector3d(0.0, 0.0, 9.81);
  return imu;
}

sensor::Wheel SyntheticDrive::wheel(double seconds) const {
  const State s = state(seconds);
  return {stamp_from_ns(std::llround(seconds * 1e9)), s.speed, s.yaw_rate};
}

}  // namespace fleetmap::testing
