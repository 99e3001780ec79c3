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

/// What a world is made from.
using WorldSpec = std::variant<SolarFarmConfig, MeshWorld>;

/// `seed` replaces a solar farm's own; a mesh has none. Errors say what to change and name the mesh's file.
Result<std::shared_ptr<const World>> build_world(const WorldSpec& spec,
                                                 std::optional<std::uint64_t> seed = std::nullopt);

}  // namespace fleetmap::sim
