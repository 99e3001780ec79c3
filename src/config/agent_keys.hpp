#pragma once

#include <yaml-cpp/yaml.h>

#include <set>
#include <string>

namespace fleetmap::config {

/// Keys that an agent's file, entry or defaults may hold.
std::set<std::string> agent_keys();
/// An agent's keys at the top of a fleet's file, which are laid on every agent; --set writes there.
YAML::Node agent_keys_of(const YAML::Node& root, const std::set<std::string>& known);

}  // namespace fleetmap::config
