#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

namespace fleetmap::monitor {

/// To 1 / `steps`: digits beyond what a page shows would be most of a message.
inline double rounded(double value, double steps) { return std::round(value * steps) / steps; }

/// null where there is no finite number: JSON has none for infinity.
inline nlohmann::json optional_json(const std::optional<double>& value, double steps) {
  return value && std::isfinite(*value) ? nlohmann::json(rounded(*value, steps)) : nlohmann::json();
}

}  // namespace fleetmap::monitor
