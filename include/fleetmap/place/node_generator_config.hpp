#pragma once

#include "fleetmap/core/result.hpp"

namespace fleetmap::place {

/// Spacing of nodes (Alg. 1).
struct NodeGeneratorConfig {
  double spacing =
      5.0;  ///< m, D_thresh: how far the robot goes, in odometry, before it freezes the next node

  Status validate() const;
};

}  // namespace fleetmap::place
