#pragma once

#include "fleetmap/core/result.hpp"

namespace fleetmap::planning {

/// Short-range link and timing of planned exchanges.
struct RendezvousConfig {
  double c_max = 90.0;                  ///< m, reach of the short-range link (C_max of the paper)
  double bandwidth = 15e6;              ///< bit/s of the short-range link: one channel for the whole fleet
  double efficiency = 0.7;              ///< share of `bandwidth` that carries maps
  double map_bytes_per_metre = 6000.0;  ///< of submaps that a robot makes per metre driven
  double spacing = 4.0;                 ///< m between robots that wait
  double sample_period = 2.0;           ///< s, step of the forecast of who passes whom and what flows then
  double stop_overhead = 10.0;          ///< s that a stop takes besides the transfer: find, stop, agree
  double min_gain = 30.0;  ///< s by which a stop must make the fleet complete earlier to be worth it
  Status validate() const;
};

}  // namespace fleetmap::planning
