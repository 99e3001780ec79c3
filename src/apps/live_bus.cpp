#include "live_bus.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>

namespace fleetmap::apps {

Result<std::unique_ptr<bus::DdsBus>> join_dds(const bus::DdsBusConfig& config) {
  auto made = bus::DdsBus::create(config);
  if (!made) return made;
  for (const std::string& warning : (*made)->warnings()) spdlog::warn("{}: {}", config.agent.str(), warning);
  return made;
}

AgentId free_name(const std::string& wanted, const std::vector<AgentId>& robots) {
  AgentId name = *AgentId::parse(wanted);
  for (int k = 1; std::ranges::find(robots, name) != robots.end(); ++k)
    name = *AgentId::parse(wanted.substr(0, 2) + "-" + std::to_string(k));
  return name;
}

}  // namespace fleetmap::apps
