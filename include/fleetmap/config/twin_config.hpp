#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "fleetmap/planning/mission/mission_config.hpp"

namespace fleetmap::config {

/// The digital twin of a fleet: its world, and what the robots do there.
struct TwinConfig {
  std::filesystem::path world;        ///< WORLD.yaml
  std::optional<std::uint64_t> seed;  ///< instead of the world's own; robots' seeds follow from it
  planning::MissionConfig mission;
  std::string mission_at;               ///< file, line and key, for messages
  double map_error = 0.5;               ///< m, by which the drawing that the fleet plans on is off
  std::uint32_t unknown_obstacles = 0;  ///< parked things that the drawing lacks
  double max_time = 3600.0;             ///< s of virtual time until robots that have not finished are stopped
};

}  // namespace fleetmap::config
