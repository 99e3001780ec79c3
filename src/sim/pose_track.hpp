#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::sim {

/// Poses at even steps, and any between them: translation linear, rotation about a fixed axis (as
/// interpolate(), but fast enough for every ray).
class PoseTrack {
 public:
  /// `step` s; at least two poses.
  PoseTrack(const std::vector<Pose>& poses, double step) : step_(step) {
    for (std::size_t k = 0; k + 1 < poses.size(); ++k) {
      Segment segment{poses[k].linear(), poses[k].translation(),
                      poses[k + 1].translation() - poses[k].translation(), Eigen::Matrix3d::Zero(), 0.0};
      const Eigen::Vector3d turn = so3_log(poses[k].linear().transpose() * poses[k + 1].linear());
      segment.angle = turn.norm();
      if (segment.angle > 0.0) segment.axis = skew(turn / segment.angle);
      segments_.push_back(segment);
    }
  }

  /// `seconds` after the first pose; held at the ends.
  void at(double seconds, Eigen::Matrix3d& R, Eigen::Vector3d& t) const {
    const double last = static_cast<double>(segments_.size());
    const double at = std::clamp(step_ > 0.0 ? seconds / step_ : 0.0, 0.0, last);
    const auto k = std::min(static_cast<std::size_t>(at), segments_.size() - 1);
    const Segment& segment = segments_[k];
    const double alpha = at - static_cast<double>(k), angle = alpha * segment.angle;
    R = segment.R;
    if (angle > 0.0) {
      const Eigen::Matrix3d Rk = segment.R * segment.axis;
      const auto [sine, versine] = sine_and_versine(angle);
      R += sine * Rk + versine * Rk * segment.axis;
    }
    t = segment.t + alpha * segment.move;
  }

 private:
  /// sin(x) and 1 - cos(x); the series of a small angle is exact to 1e-15.
  static std::pair<double, double> sine_and_versine(double x) {
    if (x > 0.03) return {std::sin(x), 1.0 - std::cos(x)};
    const double q = x * x;
    return {x * (1.0 - q / 6.0 * (1.0 - q / 20.0 * (1.0 - q / 42.0))),
            q / 2.0 * (1.0 - q / 12.0 * (1.0 - q / 30.0))};
  }
  struct Segment {
    Eigen::Matrix3d R;
    Eigen::Vector3d t, move;
    Eigen::Matrix3d axis;  ///< skew of the unit axis of the turn to the next pose
    double angle;          ///< rad
  };
  double step_;
  std::vector<Segment> segments_;
};

}  // namespace fleetmap::sim
