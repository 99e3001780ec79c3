#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iosfwd>

#include "fleetmap/core/result.hpp"
#include "fleetmap/sim/world.hpp"

namespace fleetmap::apps {

/// Settings of the files of a world.
struct WorldFiles {
  std::uint64_t seed = 1;
  double map_error = 0.5;  ///< m, by which the drawing of the site is off
  double density = 400.0;  ///< ground-truth points per m^2 of surface
  std::size_t max_points = 20'000'000;
};

/// Prints size, mesh, lanes and drivable share of a world.
void describe_world(std::ostream& out, const sim::World& world);

/// Writes world.ply, world.obj, truth.ply and, for a world with lanes, site.geojson into `folder`, which is
/// made. Prints what was written.
Status write_world(std::ostream& out, const sim::World& world, const std::filesystem::path& folder,
                   const WorldFiles& settings);

}  // namespace fleetmap::apps
