#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "fleetmap/core/ids.hpp"

namespace fleetmap::monitor {

inline nlohmann::json names_json(const std::vector<AgentId>& robots) {
  nlohmann::json names = nlohmann::json::array();
  for (const AgentId& robot : robots) names.push_back(robot.str());
  return names;
}

}  // namespace fleetmap::monitor
