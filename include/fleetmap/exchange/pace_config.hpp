#pragma once

namespace fleetmap::exchange {

/// Configuration of Pace.
struct PaceConfig {
  double burst_seconds = 0.2;     ///< s, of the rate, that may go at once after silence
  double min_burst_bytes = 1400;  ///< B, at least one full fragment with its headers
  double peak = 1.1;              ///< of the rate, in any second
};

}  // namespace fleetmap::exchange
