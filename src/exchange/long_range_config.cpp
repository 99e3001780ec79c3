#include "fleetmap/exchange/long_range_config.hpp"

#include <cmath>

namespace fleetmap::exchange {

Status LongRangeConfig::validate() const {
  if (!(fleet_bytes_per_second > 0.0) || !std::isfinite(fleet_bytes_per_second)) {
    return failure("long_range.fleet_bytes_per_second must be positive");
  }
  if (!(pace.burst_seconds >= 0.0) || pace.burst_seconds > 10.0)
    return failure("long_range.burst_seconds must be in 0 .. 10");
  if (!(pace.min_burst_bytes >= 0.0) || pace.min_burst_bytes > 1e6) {
    return failure("long_range.min_burst_bytes must be in 0 .. 1e6");
  }
  if (!(pace.peak >= 1.0) || pace.peak > 100.0) return failure("long_range.peak must be in 1 .. 100");
  if (!(small_reserve_bytes >= 0.0) || small_reserve_bytes > 1e6) {
    return failure("long_range.small_reserve_bytes must be in 0 .. 1e6");
  }
  if (max_small == 0 || max_backfill == 0 || max_fragments == 0) {
    return failure("long_range.max_small, max_backfill and max_fragments must be at least 1");
  }
  return {};
}

}  // namespace fleetmap::exchange
