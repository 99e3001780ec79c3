#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>

#include "fleetmap/core/time.hpp"

namespace fleetmap::sensor {

/// Integral over time of rates that come as samples, by trapezoids. Answers for the last 3 s; a gap of more
/// than 0.5 s, or a stamp that is not later, begins anew.
class RunningIntegral {
 public:
  void add(Stamp stamp, const Eigen::Vector3d& rate);
  /// Between two instants; empty unless samples cover both.
  std::optional<Eigen::Vector3d> between(Stamp from, Stamp to) const;
  std::optional<Stamp> last() const;

 private:
  struct Entry {
    Stamp stamp;
    Eigen::Vector3d rate, sum;
  };
  std::optional<Eigen::Vector3d> at(Stamp stamp) const;

  std::deque<Entry> entries_;
};

}  // namespace fleetmap::sensor
