#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fleetmap/agent/perception_config.hpp"

namespace fleetmap::apps {

/// Messages that came of a robot's sensors, also those that could not be decoded.
struct SensorSamples {
  std::uint64_t imu = 0, fixes = 0, wheel = 0;
};

/// A sentence on each topic of IMU, GPS and wheels on which no message came, unless the configuration
/// switches its use off.
std::vector<std::string> silent_topics(const agent::PerceptionConfig& config, const SensorSamples& heard);

}  // namespace fleetmap::apps
