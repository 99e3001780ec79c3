#include "live_bus.hpp"

#include <spdlog/spdlog.h>

namespace fleetmap::apps {

Result<std::unique_ptr<bus::DdsBus>> join_dds(const bus::DdsBusConfig& config) {
  auto made = bus::DdsBus::create(config);
  if (!made) return made;
  for (const std::string& warning : (*made)->warnings()) spdlog::warn("{}: {}", config.agent.str(), warning);
  return made;
}

}  // namespace fleetmap::apps
