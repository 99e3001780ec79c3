#pragma once

#include <optional>

#include "fleetmap/config/recording_config.hpp"
#include "yaml_section.hpp"

namespace fleetmap::config {

/// `recording`: the source of the sensor samples; empty without the key.
std::optional<RecordingConfig> read_recording(Section& top);

}  // namespace fleetmap::config
