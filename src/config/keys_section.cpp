#include "keys_section.hpp"

#include <chrono>
#include <memory>
#include <utility>

#include "fleetmap/agent/item_keys.hpp"
#include "fleetmap/bus/wire_overhead.hpp"
#include "fleetmap/core/utc.hpp"
#include "fleetmap/trust/credentials.hpp"

namespace fleetmap::config {

void read_keys(Section& top, bool of_fleet, agent::AgentConfig& agent, bus::DdsBusConfig& dds) {
  if (!top.has("keys")) return;
  std::filesystem::path folder;
  top.read_path("keys", folder);
  if (of_fleet) folder /= agent.id.str();
  const auto now = system_now();
  auto keys = trust::load_credentials(folder, now);
  if (!keys) return top.problem("keys", keys.error().message);
  if (keys->certificate.name != agent.id) {
    return top.problem("keys", folder.string() + " is the folder of " + keys->certificate.name.str() +
                                   "; expected that of " + agent.id.str());
  }
  dds.keys = std::make_shared<const trust::Credentials>(*std::move(keys));
  agent.exchange.long_range.overhead_bytes += bus::kSealBytes;
  agent.exchange.authenticator = std::make_shared<const agent::ItemKeys>(dds.keys);
}

}  // namespace fleetmap::config
