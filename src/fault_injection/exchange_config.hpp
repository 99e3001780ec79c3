#pragma once

#include "fleetmap/exchange/exchange.hpp"
#include "fleetmap/fault_injection/scenario.hpp"

namespace fleetmap::fault_injection {

/// The configuration of the exchange of a scenario's robots r1, r2, ... Its queues are so short that a small
/// fleet fills them.
exchange::ExchangeConfig exchange_config_of(const Scenario& scenario, bool signatures);

}  // namespace fleetmap::fault_injection
