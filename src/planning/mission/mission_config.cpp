#include "fleetmap/planning/mission/mission_config.hpp"

#include <cmath>

namespace fleetmap::planning {

Status MissionConfig::validate() const {
  if (rows.every < 1) return failure("every: must be at least 1");
  if (!(rows.max_row_length == 0.0 || rows.max_row_length >= 1.0)) {
    return failure("max_row_length: must be at least 1 m, or 0 for no limit");
  }
  if (!(std::isfinite(speed) && speed > 0.0)) return failure("speed: must be > 0 m/s");
  for (const Status& status :
       {division.validate(), routes.validate(), meeting.validate(), executive.validate()}) {
    if (!status) return status;
  }
  return {};
}

}  // namespace fleetmap::planning
