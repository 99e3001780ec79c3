#include "exchange_config.hpp"

#include <memory>
#include <string>

#include "fleetmap/fault_injection/simulated_signatures.hpp"
#include "fleetmap/fleet_codec/messages.hpp"

namespace fleetmap::fault_injection {

exchange::ExchangeConfig exchange_config_of(const Scenario& scenario, bool signatures) {
  exchange::ExchangeConfig config;
  if (signatures) config.authenticator = std::make_shared<SimulatedSignatures>(scenario.seed);
  for (std::size_t k = 0; k < scenario.robots; ++k)
    config.fleet.push_back(AgentId::parse(std::string("r").append(std::to_string(k + 1))).value());
  config.long_range.max_small = 24;
  config.long_range.max_backfill = 32;
  config.long_range.max_fragments = 16;
  config.payload_size = [](const messages::Message& message) { return fleet_codec::encode(message).size(); };
  return config;
}

}  // namespace fleetmap::fault_injection
