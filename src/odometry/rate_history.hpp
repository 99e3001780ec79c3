#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <deque>
#include <optional>

#include "fleetmap/core/time.hpp"

namespace fleetmap::odometry {

/// The last samples of a rate (gyro: rad/s; wheels: m/s and rad/s), linear in between. Bounded.
class RateHistory {
 public:
  /// False, and the sample is dropped, if it is not finite or not later than the last one. A sample more than
  /// a second earlier means that the clock was set: the history starts anew.
  bool add(Stamp stamp, const Eigen::Vector3d& rate);
  /// Mean over [from, to], by the trapezoid rule; the outermost samples are held for at most `hold`.
  /// Empty if the samples do not cover the interval.
  std::optional<Eigen::Vector3d> mean(Stamp from, Stamp to, Duration hold) const;
  /// Rotation from the body at `from` to the body at `to` for angular rates minus `bias`. Empty as for
  /// mean().
  std::optional<Eigen::Matrix3d> rotation(Stamp from, Stamp to, const Eigen::Vector3d& bias,
                                          Duration hold) const;
  /// Slope of the rate over [from, to] and its variance.
  struct Trend {
    Eigen::Vector3d slope;     ///< of the line through the samples, rate units / s
    Eigen::Vector3d variance;  ///< of the slope, by how far the samples lie off the line
  };
  /// Empty if fewer than five samples lie within the interval.
  std::optional<Trend> trend(Stamp from, Stamp to) const;
  std::size_t size() const { return samples_.size(); }

 private:
  struct Sample {
    Stamp stamp;
    Eigen::Vector3d rate;
  };
  bool covers(Stamp from, Stamp to, Duration hold) const;
  Eigen::Vector3d at(Stamp stamp) const;
  /// Calls visit(seconds, rate, rate at the end) for the pieces into which samples divide the interval.
  template <class Visitor>
  void for_each_piece(Stamp from, Stamp to, const Visitor& visit) const;

  std::deque<Sample> samples_;
};

}  // namespace fleetmap::odometry
