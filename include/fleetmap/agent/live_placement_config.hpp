#pragma once

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"

namespace fleetmap::agent {

/// Configuration of the solutions of the fleet's graph while driving. The final placement has none of this.
struct LivePlacementConfig {
  Duration period = std::chrono::seconds(5);  ///< between solutions, at least, and only if anything is new
  /// Share of one core that solutions may take, (0, 1]. A solution costs in proportion to the nodes, so the
  /// pause after it does, too: 2 ms a node, 20 s with 10,000. Meanwhile the odometry extrapolates.
  double cpu_share = 0.02;
  /// CPU time that a solution takes a node of the fleet: 40 us on one core of a Xeon with AVX-512.
  Duration cost_per_node = std::chrono::microseconds(40);
  Status validate() const;
};

}  // namespace fleetmap::agent
