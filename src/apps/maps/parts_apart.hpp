#pragma once

#include <iosfwd>

#include "fleetmap/output/map_parts.hpp"

namespace fleetmap::apps {

/// Names to `err`, a line a part, the frames that cannot be laid onto the map.
void name_parts_apart(const output::MapParts& parts, std::ostream& err);

}  // namespace fleetmap::apps
