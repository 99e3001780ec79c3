#pragma once

#include <vector>

#include "fleetmap/core/result.hpp"

namespace fleetmap::sim {

/// No fixes from `from` to `until`, s since the start of the run.
struct GpsOutage {
  double from = 0.0;
  double until = 0.0;
};

/// Rate and errors of the twin's GPS receiver.
struct GpsSpec {
  bool fitted = true;              ///< the robot has a receiver
  double rate = 5.0;               ///< Hz
  double white_sigma = 0.3;        ///< m, per horizontal axis, independent from fix to fix
  double drift_sigma = 1.0;        ///< m, per horizontal axis, Gauss-Markov
  double correlation_time = 60.0;  ///< s, of the drift
  double vertical_factor = 2.0;    ///< both sigmas, up against horizontal
  /// Reported variance against the true mean one of white and drift (jumps are never reported).
  double covariance_factor = 1.0;
  std::vector<GpsOutage> outages;
  double jumps_per_hour = 0.0;     ///< multipath: the fix is elsewhere for a while, Poisson
  double jump_size = 8.0;          ///< m, horizontally, in a random direction
  double jump_duration = 15.0;     ///< s
  double altitude_wave = 0.0;      ///< m, amplitude of a sine that the altitude is off by; never reported
  double altitude_period = 240.0;  ///< s, of that sine; its phase is drawn from the seed
  Status validate() const;
};

}  // namespace fleetmap::sim
