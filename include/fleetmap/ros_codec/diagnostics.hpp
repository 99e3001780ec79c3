#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/time.hpp"

namespace fleetmap::ros_codec {

/// A diagnostic_msgs/DiagnosticArray.
struct DiagnosticsMsg {
  enum class Level : std::uint8_t { ok = 0, warning = 1, error = 2, stale = 3 };
  struct Item {
    Level level = Level::ok;
    std::string name, message, hardware_id;
    std::vector<std::pair<std::string, std::string>> values;
  };
  Stamp stamp;
  std::vector<Item> items;
};
Bytes encode(const DiagnosticsMsg& diagnostics);

}  // namespace fleetmap::ros_codec
