#pragma once

#include <string>

namespace fleetmap::apps {

inline const std::string kSite = FLEETMAP_SOURCE_DIR "/config/sites/farm_200.geojson";

}  // namespace fleetmap::apps
