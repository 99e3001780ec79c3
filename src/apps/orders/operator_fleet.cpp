#include "operator_fleet.hpp"

#include <algorithm>

#include "fleetmap/config/file_kind.hpp"
#include "fleetmap/config/fleet_file.hpp"
#include "fleetmap/config/robot_file.hpp"
#include "robot/live_bus.hpp"

namespace fleetmap::apps {

Result<OperatorFleet> operator_fleet(const std::string& file,
                                     const std::vector<config::Override>& overrides) {
  const auto kind = config::check(file, overrides);
  if (!kind) return tl::unexpected(kind.error());
  OperatorFleet fleet;
  if (*kind == config::FileKind::kFleet) {
    auto loaded = config::load_fleet(file, overrides);
    if (!loaded) return tl::unexpected(loaded.error());
    for (const auto& member : loaded->members) fleet.robots.push_back(member.agent.id);
    fleet.dds = loaded->members.front().dds;
  } else if (*kind == config::FileKind::kRobot) {
    auto loaded = config::load_robot(file, overrides);
    if (!loaded) return tl::unexpected(loaded.error());
    fleet.robots = loaded->agent.exchange.fleet;
    fleet.dds = loaded->dds;
  } else {
    return failure(file + ": is no robot's and no fleet's configuration");
  }
  fleet.dds.agent = free_name("operator", fleet.robots);
  fleet.dds.settings.reset();
  fleet.dds.onboard.enabled = false;
  fleet.dds.short_range.enabled = false;
  bus::DdsLinkConfig& radio = fleet.dds.long_range;
  // A robot's file names the others; its own agent may run here.
  if (!radio.peers.empty()) radio.peers.push_back(radio.address.empty() ? "127.0.0.1" : radio.address);
  return fleet;
}

Result<AgentId> robot_named(const OperatorFleet& fleet, const std::string& name, const std::string& file) {
  const auto found = std::ranges::find_if(fleet.robots, [&](const AgentId& id) { return id.str() == name; });
  return found == fleet.robots.end() ? failure(file + ": has no robot '" + name + "'")
                                     : Result<AgentId>(*found);
}

}  // namespace fleetmap::apps
