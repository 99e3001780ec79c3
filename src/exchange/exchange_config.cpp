#include "fleetmap/exchange/exchange_config.hpp"

#include <algorithm>
#include <set>

namespace fleetmap::exchange {
namespace {

/// Datagrams per B/s of the budget for which the default periods are made: five robots, each to each other.
constexpr double kUsualLoad = 5.0 * 4.0 / 18'125.0;

Duration stretched(Duration period, double factor) { return from_seconds(to_seconds(period) * factor); }

}  // namespace

Status ExchangeConfig::validate(const AgentId& self) const {
  if (std::ranges::count(fleet, self) != 1) {
    return failure("exchange.fleet must name this agent '" + self.str() + "' once");
  }
  const std::set<AgentId> names(fleet.begin(), fleet.end());
  if (names.size() != fleet.size() || names.contains(AgentId{})) {
    return failure("exchange.fleet must name every agent once");
  }
  if (!payload_size) return failure("exchange.payload_size must be set");
  if (status_period <= Duration::zero()) return failure("exchange.status_period must be positive");
  const std::set<AgentId> radio(on_radio.begin(), on_radio.end());
  if (!on_radio.empty() && (radio.size() != on_radio.size() || !radio.contains(self))) {
    return failure("long_range.robots must name each robot once, and this one, '" + self.str() + "'");
  }
  for (const AgentId& agent : on_radio) {
    if (!names.contains(agent))
      return failure("long_range.robots: '" + agent.str() + "' is not in the fleet");
  }
  for (const Status& status :
       {long_range.validate(), clouds.validate(), reconcile.validate(), submaps.validate()}) {
    if (!status) return status;
  }
  return {};
}

Duration for_fleet(Duration period, const ExchangeConfig& config) {
  const std::size_t robots = std::max<std::size_t>(config.all_on_radio().size(), 2);
  const double load = static_cast<double>(robots * config.long_range.copies(robots)) /
                      config.long_range.fleet_bytes_per_second;
  return stretched(period, std::max(1.0, load / kUsualLoad));
}

ExchangeConfig for_fleet(ExchangeConfig config) {
  config.on_radio = config.all_on_radio();
  for (Duration* period : {&config.status_period, &config.reconcile.digest_min_period,
                           &config.reconcile.digest_max_period, &config.reconcile.peer_timeout}) {
    *period = for_fleet(*period, config);
  }
  return config;
}

}  // namespace fleetmap::exchange
