#pragma once

#include <filesystem>
#include <iosfwd>

#include "fleetmap/core/result.hpp"
#include "fleetmap/sim/world.hpp"
#include "world_file_options.hpp"

namespace fleetmap::apps {

/// Prints size, mesh, lanes and drivable share of a world.
void describe_world(std::ostream& out, const sim::World& world);

/// Writes world.ply, world.obj, truth.ply and, for a world with lanes, site.geojson into `folder`, which is
/// made. Prints what was written.
Status write_world(std::ostream& out, const sim::World& world, const std::filesystem::path& folder,
                   const WorldFileOptions& settings);

}  // namespace fleetmap::apps
