#pragma once

#include <cstddef>
#include <cstdint>

namespace fleetmap::apps {

/// Settings of the files of a world.
struct WorldFileOptions {
  std::uint64_t seed = 1;
  double map_error = 0.5;  ///< m, by which the drawing of the site is off
  double density = 400.0;  ///< ground-truth points per m^2 of surface
  std::size_t max_points = 20'000'000;
};

}  // namespace fleetmap::apps
