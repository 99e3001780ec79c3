#include "fleetmap/sim/robot_twin_config.hpp"

#include <cmath>

#include "spec_rules.hpp"

namespace fleetmap::sim {

Status RobotTwinConfig::validate() const {
  if (!start.allFinite() || !std::isfinite(start_yaw)) return failure("start: must be finite");
  if (!all_finite(T_base_lidar) || !all_finite(T_base_imu) || !p_base_antenna.allFinite()) {
    return failure("mounts: must be finite");
  }
  return first_failure({named("lidar", lidar.validate()), named("imu", imu.validate()),
                        named("gps", gps.validate()), named("wheels", wheels.validate()),
                        named("vehicle", vehicle.validate())});
}

}  // namespace fleetmap::sim
