#pragma once

#include <cstdint>
#include <memory>

#include "fleetmap/core/result.hpp"
#include "fleetmap/sim/solar_farm_config.hpp"
#include "fleetmap/sim/world.hpp"

namespace fleetmap::sim {

/// Builds the site. World::aisles() are the lanes between the rows and along the outer sides of the first and
/// the last, from headland to headland, south to north (for the default azimuth). Fails for an invalid
/// configuration, and if the ground leaves a lane impassable for a robot of 0.35 m radius. The same
/// configuration yields the same bytes.
Result<std::shared_ptr<const World>> make_solar_farm(const SolarFarmConfig& config);

}  // namespace fleetmap::sim
