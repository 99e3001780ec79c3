#include "fleetmap/agent/sensor_facts.hpp"

#include <utility>

#include "fleetmap/output/lidar_mount.hpp"
#include "fleetmap/output/sea_level_heights.hpp"

namespace fleetmap::agent {

Status SensorFacts::keep(store::Store& store, const Perception& perception) {
  if (perception.health().heights_above_sea_level() && !std::exchange(heights_kept_, true)) {
    if (const Status kept = output::keep_sea_level_heights(store); !kept) return kept;
  }
  if (std::exchange(mount_kept_, true)) return {};
  return output::keep_lidar_mount(store, perception.T_base_lidar().translation());
}

}  // namespace fleetmap::agent
