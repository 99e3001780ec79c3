#pragma once

#include <Eigen/Core>

#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::odometry {

/// Constant velocity of base_link during a sweep, in base_link: [linear m/s, angular rad/s].
class ConstantTwist {
 public:
  explicit ConstantTwist(const Vector6d& twist)
      : linear_(twist.head<3>().cast<float>()), angular_(twist.tail<3>().cast<float>()) {}

  /// Point seen at `seconds` after the reference instant, moved into base_link at the reference instant:
  /// exp(seconds * twist) p. Series to the fourth power: exact to 3e-4 rad at half a radian of turn.
  Eigen::Vector3f at_reference(const Eigen::Vector3f& p, float seconds) const {
    const Eigen::Vector3f d1 = linear_ + angular_.cross(p);
    const Eigen::Vector3f d2 = angular_.cross(d1);
    const Eigen::Vector3f d3 = angular_.cross(d2);
    const Eigen::Vector3f d4 = angular_.cross(d3);
    const float s = seconds;
    return p + s * (d1 + s * (0.5f * d2 + s * (d3 / 6.0f + s * d4 / 24.0f)));
  }

 private:
  Eigen::Vector3f linear_, angular_;
};

}  // namespace fleetmap::odometry
