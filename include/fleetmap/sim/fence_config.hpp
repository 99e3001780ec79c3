#pragma once

#include "fleetmap/core/result.hpp"

namespace fleetmap::sim {

/// Around the site.
struct FenceConfig {
  bool enabled = true;
  double height = 2.0;        ///< m
  double post_spacing = 3.0;  ///< m
  double wire_spacing = 0.1;  ///< m between the upright wires of a panel; 0: posts and rails only
  double wire_width = 0.01;   ///< m
  Status validate() const;
};

}  // namespace fleetmap::sim
