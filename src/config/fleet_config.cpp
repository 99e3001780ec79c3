#include "fleetmap/config/fleet_config.hpp"

#include <algorithm>

#include "fleetmap/config/fleet_agreement.hpp"

namespace fleetmap::config {

void FleetConfig::keep_first(std::size_t count) {
  members.resize(std::min(count, members.size()));
  std::vector<AgentId> names;
  for (const Member& member : members) names.push_back(member.agent.id);
  for (Member& member : members) {
    member.agent.exchange.fleet = names;
    std::erase_if(member.agent.exchange.on_radio,
                  [&](const AgentId& id) { return std::ranges::find(names, id) == names.end(); });
    member.dds.settings = fleet_settings(member.agent);
  }
}

}  // namespace fleetmap::config
