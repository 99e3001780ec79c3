#include "fleetmap/exchange/delay_window_config.hpp"

#include <cmath>
#include <string>

namespace fleetmap::exchange {

Status DelayWindowConfig::validate() const {
  if (!(target_s >= kMinTarget) || !std::isfinite(target_s))
    return failure("submap_transfer.window.target_s must be at least 0.05");
  if (step_bytes == 0 || min_bytes < step_bytes || first_bytes < min_bytes || max_bytes < first_bytes) {
    return failure("short_range.window_bytes must be at least " + std::to_string(first_bytes) +
                   ", and submap_transfer.window's step_bytes, min_bytes and first_bytes must not decrease");
  }
  return {};
}

}  // namespace fleetmap::exchange
