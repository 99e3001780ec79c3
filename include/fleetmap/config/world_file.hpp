#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "fleetmap/core/result.hpp"
#include "fleetmap/sim/world_spec.hpp"

namespace fleetmap::config {

/// A world of the twin: WORLD.yaml, `kind: solar_farm` or `kind: mesh`. Every problem is reported with file,
/// line and key, all at once. A mesh's path is relative to the file; the mesh itself is not read yet.
Result<sim::WorldSpec> load_world(const std::filesystem::path& file);

/// Loads and builds it (sim::build_world); every error names the file. `seed` replaces that of a solar farm.
Result<std::shared_ptr<const sim::World>> make_world(const std::filesystem::path& file,
                                                     std::optional<std::uint64_t> seed = std::nullopt);

}  // namespace fleetmap::config
