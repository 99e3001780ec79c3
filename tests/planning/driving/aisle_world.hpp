#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <vector>

#include "fleetmap/planning/driving/path_follower.hpp"

namespace fleetmap::planning::testing {

/// Points at robot height, and a skid-steer robot among them that only knows its position with an error.
class AisleWorld {
 public:
  std::vector<Eigen::Vector2d> points;
  Pose2 truth;
  double speed = 0.0;
  double yaw_rate = 0.0;
  double radius = 0.35;

  double nearest = std::numeric_limits<double>::infinity();  ///< m, least distance to any point so far
  double driven = 0.0;                                       ///< m
  int reversals = 0;                                         ///< of the sign of a noticeable yaw rate

  void wall(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double spacing = 0.1) {
    const double length = (b - a).norm();
    const int count = static_cast<int>(length / spacing);
    for (int k = 0; k <= count; ++k) points.push_back(a + (b - a) * k / std::max(1, count));
  }
  void box(const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
    wall(low, {high.x(), low.y()});
    wall({high.x(), low.y()}, high);
    wall(high, {low.x(), high.y()});
    wall({low.x(), high.y()}, low);
  }

  std::vector<Eigen::Vector2d> scan() const {
    std::vector<Eigen::Vector2d> visible;
    const Eigen::Rotation2Dd back(-truth.yaw);
    for (const Eigen::Vector2d& p : points) {
      if ((p - truth.position).squaredNorm() < 100.0) visible.push_back(back * (p - truth.position));
    }
    return visible;
  }

  /// A step of the chassis: it needs about 0.3 s to follow a command.
  void step(const Command& command, double dt) {
    speed += (command.forward_speed - speed) * std::min(1.0, dt / 0.2);
    const double rate = yaw_rate + (command.yaw_rate - yaw_rate) * std::min(1.0, dt / 0.2);
    if (rate * last_turn_ < 0.0 && std::abs(rate) > 0.3) ++reversals;
    if (std::abs(rate) > 0.3) last_turn_ = rate;
    yaw_rate = rate;
    truth.yaw += yaw_rate * dt;
    const Eigen::Vector2d move = speed * dt * Eigen::Vector2d(std::cos(truth.yaw), std::sin(truth.yaw));
    truth.position += move;
    driven += move.norm();
    for (const Eigen::Vector2d& p : points) nearest = std::min(nearest, (p - truth.position).norm());
  }

 private:
  double last_turn_ = 0.0;
};

}  // namespace fleetmap::planning::testing
