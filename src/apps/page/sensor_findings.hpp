#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fleetmap/agent/perception.hpp"
#include "fleetmap/sensor/clock_offsets.hpp"

namespace fleetmap::apps {

/// A finding of the checks of a robot's sensors, in short: without its remedy.
struct SensorFinding {
  std::optional<sensor::Source> source;  ///< empty: of none alone
  std::string text;
  bool is_over = false;  ///< the clock agrees again, or the sensor sends again
};

/// All findings but notes, in the order in which they were found.
std::vector<SensorFinding> sensor_findings(const agent::Perception& perception, Stamp now);

}  // namespace fleetmap::apps
