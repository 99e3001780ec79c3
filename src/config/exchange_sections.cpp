#include "exchange_sections.hpp"

#include <string>

namespace fleetmap::config {

void read_names(Section& section, const char* key, std::vector<AgentId>& ids) {
  std::vector<std::string> names;
  section.read(key, names);
  for (const std::string& name : names) {
    if (const auto parsed = AgentId::parse(name)) {
      ids.push_back(*parsed);
    } else {
      section.problem(key, parsed.error().message);
    }
  }
}

void read_exchange(Section& top, agent::AgentConfig& agent) {
  exchange::ExchangeConfig& exchange = agent.exchange;
  Section long_range = top.section("long_range");
  double budget_kbit_s = exchange.long_range.fleet_bytes_per_second * 8e-3;
  long_range.read("budget_kbit_s", budget_kbit_s);
  exchange.long_range.fleet_bytes_per_second = budget_kbit_s * 125.0;
  read_names(long_range, "robots", exchange.on_radio);
  long_range.read("burst_seconds", exchange.long_range.pace.burst_seconds);
  long_range.read_seconds("status_period", exchange.status_period);
  long_range.read_seconds("digest_min_period", exchange.reconcile.digest_min_period);
  long_range.read_seconds("digest_max_period", exchange.reconcile.digest_max_period);
  long_range.finish();
  long_range.check(exchange.long_range.validate());
  long_range.check(exchange.reconcile.validate());

  Section short_range = top.section("short_range");
  double rate_mbit_s = exchange.submaps.bytes_per_second * 8e-6;
  short_range.read("rate_mbit_s", rate_mbit_s);
  exchange.submaps.bytes_per_second = rate_mbit_s * 125e3;
  short_range.read("window_bytes", exchange.submaps.window.max_bytes);
  short_range.read_seconds("peer_timeout", exchange.submaps.peer_timeout);
  short_range.finish();
  short_range.check(exchange.submaps.validate());
}

}  // namespace fleetmap::config
