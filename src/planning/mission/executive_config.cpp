#include "fleetmap/planning/mission/executive_config.hpp"

#include <cmath>

namespace fleetmap::planning {

Status ExecutiveConfig::validate() const {
  const auto positive = [](double x) { return std::isfinite(x) && x > 0.0; };
  if (!positive(lost_after)) return failure("lost_after: must be > 0 s");
  if (!(std::isfinite(listen) && listen >= 0.0)) return failure("listen: must be >= 0 s");
  if (!positive(orphan_wait)) return failure("orphan_wait: must be > 0 s");
  if (!(std::isfinite(offer_gain) && offer_gain >= 0.0)) return failure("offer_gain: must be >= 0 s");
  if (!positive(offer_period)) return failure("offer_period: must be > 0 s");
  if (!(low_battery >= 0.0 && low_battery < 1.0)) return failure("low_battery: must be within [0, 1)");
  if (row_attempts < 1) return failure("row_attempts: must be at least 1");
  if (stuck_limit < 1) return failure("stuck_limit: must be at least 1");
  if (!positive(stuck_retry)) return failure("stuck_retry: must be > 0 s");
  if (!positive(stop_patience)) return failure("stop_patience: must be > 0 s");
  if (!positive(meeting_timeout)) return failure("meeting_timeout: must be > 0 s");
  return {};
}

}  // namespace fleetmap::planning
