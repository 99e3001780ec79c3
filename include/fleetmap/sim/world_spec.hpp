#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/sim/solar_farm.hpp"
#include "fleetmap/sim/world.hpp"

namespace fleetmap::sim {

/// A user's mesh as a world.
struct MeshWorld {
  std::filesystem::path path;  ///< .obj or .ply, metres of the site's ENU frame
  std::vector<Aisle> aisles;   ///< lanes to map along, if any
  DrivableConfig drivable;
  Status validate() const;
};

/// The source of a world.
using WorldSpec = std::variant<SolarFarmConfig, MeshWorld>;

/// `seed` replaces a solar farm's own; a mesh has none. Errors name the remedy and the mesh's file.
Result<std::shared_ptr<const World>> build_world(const WorldSpec& spec,
                                                 std::optional<std::uint64_t> seed = std::nullopt);

}  // namespace fleetmap::sim
