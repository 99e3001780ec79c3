#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace fleetmap::testing {

/// Folder `name` of the real recordings, or empty where they are not installed (those tests then say
/// skipped). FLEETMAP_SHARED_DATA names their place; the default is beside the checkout.
inline std::optional<std::filesystem::path> shared_data(const std::string& name) {
  const char* place = std::getenv("FLEETMAP_SHARED_DATA");
  const std::filesystem::path root = place != nullptr
                                         ? std::filesystem::path(place)
                                         : std::filesystem::path(FLEETMAP_SOURCE_DIR) / "../shared/data";
  std::error_code error;
  if (!std::filesystem::is_directory(root / name, error)) return std::nullopt;
  return std::filesystem::canonical(root / name);
}

}  // namespace fleetmap::testing
