#pragma once

#include "fleetmap/core/result.hpp"

namespace fleetmap::planning {

/// Clearances of routes on a site.
struct RoutePlannerConfig {
  double clearance = 0.7;  ///< m kept from keep-outs: half a robot and what its position may be off
  double cell = 0.25;      ///< m, of the raster on which this is checked (coarser above 1.5 km²)
  double snap = 5.0;       ///< m, from a start or goal too near to a keep-out to the ground it is joined with
  double margin = 15.0;    ///< m, ground around rows and keep-outs of a mission without a boundary
  Status validate() const;
};

}  // namespace fleetmap::planning
