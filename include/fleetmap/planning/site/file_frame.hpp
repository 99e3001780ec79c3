#pragma once

#include <cstdint>

namespace fleetmap::planning {

/// Coordinates of a mission's file.
enum class FileFrame : std::uint8_t {
  kWgs84,  ///< [longitude, latitude] in degrees (RFC 7946)
  kEnu,    ///< [east, north] in metres from the site's origin; member "frame": "enu"
};

}  // namespace fleetmap::planning
