#pragma once

#include <string>
#include <vector>

#include "fleetmap/config/experiment_config.hpp"
#include "yaml_section.hpp"

namespace fleetmap::config {

/// The axis whose value is the number of robots.
inline constexpr const char* kAgentsAxis = "agents";

/// True for 1 to 60 letters, digits, '_' and '-'.
bool is_name(const std::string& text);
/// Reads a list of "key=value" texts.
void read_overrides(Section& section, const std::string& key, std::vector<Override>& overrides);
Axis read_axis(Section& section);

}  // namespace fleetmap::config
