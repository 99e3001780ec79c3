#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace fleetmap::apps {

/// Options of `fleetmap map export` that only LAS has.
struct LasOptions {
  std::optional<std::string> crs;  ///< as output::parse_crs() reads it; else the UTM zone of the origin
  std::optional<std::string> geoid;
  std::optional<std::uint32_t> tile_m;

  bool any() const { return crs || geoid || tile_m; }
};

}  // namespace fleetmap::apps
