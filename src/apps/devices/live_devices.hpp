#pragma once

#include <memory>
#include <vector>

#include "device_input.hpp"
#include "fleetmap/agent/perception.hpp"
#include "fleetmap/bus/bus.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::apps {

/// Publishes the samples of a robot's `gps.nmea_device`, `gps.gpsd` and `mavlink` on its topics of fixes and
/// IMU, where its agent, a recorder and rviz2 receive them as those of a driver. The bus must outlive them.
/// Fails if the data of `gps.geoid` are not there.
Result<std::vector<std::unique_ptr<DeviceInput>>> publish_devices(const agent::PerceptionConfig& config,
                                                                  bus::Bus& bus);

}  // namespace fleetmap::apps
