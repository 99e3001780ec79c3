#pragma once

#include <Eigen/Core>

#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::odometry {

/// Motion of base_link during a sweep, in base_link: its velocity at the reference instant, [linear m/s,
/// angular rad/s], and a steady change of its turn rates, rad/s^2.
class SweepMotion {
 public:
  explicit SweepMotion(const Vector6d& twist,
                       const Eigen::Vector3d& turn_acceleration = Eigen::Vector3d::Zero())
      : linear_(twist.head<3>().cast<float>()),
        angular_(twist.tail<3>().cast<float>()),
        half_acceleration_(0.5f * turn_acceleration.cast<float>()) {}

  /// Point seen at `seconds` after the reference instant, moved into base_link at the reference instant:
  /// exp(seconds * mean twist since then) p. Series to the fourth power: exact to 3e-4 rad at half a radian
  /// of turn.
  Eigen::Vector3f at_reference(const Eigen::Vector3f& p, float seconds) const {
    const Eigen::Vector3f turn = angular_ + seconds * half_acceleration_;
    const Eigen::Vector3f d1 = linear_ + turn.cross(p);
    const Eigen::Vector3f d2 = turn.cross(d1);
    const Eigen::Vector3f d3 = turn.cross(d2);
    const Eigen::Vector3f d4 = turn.cross(d3);
    const float s = seconds;
    return p + s * (d1 + s * (0.5f * d2 + s * (d3 / 6.0f + s * d4 / 24.0f)));
  }

 private:
  Eigen::Vector3f linear_, angular_, half_acceleration_;
};

}  // namespace fleetmap::odometry
