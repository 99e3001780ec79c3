#include "fleetmap/config/override.hpp"

namespace fleetmap::config {

Result<Override> parse_override(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    return failure("--set " + text + ": expected key=value, e.g. lidar.model=os1-64");
  return Override{text.substr(0, equals), text.substr(equals + 1)};
}

}  // namespace fleetmap::config
