#pragma once

#include <string>

#include "fleetmap/core/result.hpp"

namespace fleetmap::config {

/// --set key=value: replaces a key at any depth; problems with it are reported as "--set key".
struct Override {
  std::string key;    ///< dotted: lidar.translation
  std::string value;  ///< YAML: [0, 0, 0.35]
  std::string at{};   ///< file, line and key of the override, for messages; empty: a command line's --set
};
/// "key=value" of a command line.
Result<Override> parse_override(const std::string& text);

}  // namespace fleetmap::config
