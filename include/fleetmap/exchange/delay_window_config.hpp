#pragma once

#include <cstdint>

#include "fleetmap/core/result.hpp"

namespace fleetmap::exchange {

/// Configuration of the congestion window of submap transfers (DelayWindow).
struct DelayWindowConfig {
  static constexpr double kMinTarget = 0.05;  ///< s: two ticks of both ends, with a margin
  double target_s = 0.25;               ///< s of queueing, above the least delay seen, that a flow may cause
  std::uint32_t min_bytes = 8'192;      ///< B
  std::uint32_t first_bytes = 32'768;   ///< B
  std::uint32_t max_bytes = 1'048'576;  ///< B
  std::uint32_t step_bytes = 8'192;     ///< B that it grows by in each round trip without queueing
  Status validate() const;
};

}  // namespace fleetmap::exchange
