#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace fleetmap::output {

/// Target and coordinates of a LAS export.
struct LasMapConfig {
  std::filesystem::path out;          ///< a file; with `tile` a folder
  std::optional<std::uint32_t> tile;  ///< m, edge of the square that one file holds
  std::string software;               ///< that writes it, with its version
};

}  // namespace fleetmap::output
