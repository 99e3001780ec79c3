#pragma once

#include <cstddef>

namespace fleetmap::planning {

/// Beyond these a drawing is refused.
struct DrawingLimits {
  std::size_t file_bytes = 64u << 20;
  /// m; a waypoint farther from the site's origin is taken for an error, not for a large site.
  double reach = 10'000.0;
};

}  // namespace fleetmap::planning
