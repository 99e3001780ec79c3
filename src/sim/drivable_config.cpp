#include "fleetmap/sim/drivable_config.hpp"

#include <numbers>

namespace fleetmap::sim {

Status DrivableConfig::validate() const {
  if (!(cell >= 0.05 && cell <= 5.0)) return failure("cell must be from 0.05 to 5 m");
  if (!(robot_height > 0.0 && robot_height <= 10.0)) return failure("robot_height must be within (0, 10] m");
  if (!(step_height >= 0.0 && step_height < robot_height))
    return failure("step_height must be from 0 m to below robot_height");
  if (!(max_slope_rad > 0.0 && max_slope_rad < 0.49 * std::numbers::pi))
    return failure("max_slope must be above 0 and below 88 deg");
  return {};
}

}  // namespace fleetmap::sim
