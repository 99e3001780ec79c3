#include "network_section.hpp"

#include <string>

namespace fleetmap::config {
namespace {

void read_radio(Section& network, const char* key, bus::RadioConfig& radio) {
  Section section = network.section(key);
  double kbit_s = radio.rate_bit_s * 1e-3;
  section.read("rate_kbit_s", kbit_s);
  radio.rate_bit_s = kbit_s * 1e3;
  section.read_seconds("delay", radio.delay);
  section.read("loss", radio.loss);
  section.read("max_range", radio.max_range);
  section.finish();
}

void read_blackouts(Section& network, std::vector<RadioBlackout>& blackouts) {
  for (Section& entry : network.list("blackouts")) {
    RadioBlackout blackout;
    std::string link = bus::to_string(blackout.link), agent;
    entry.read("link", link);
    if (link != bus::to_string(bus::Link::kShortRange) && link != bus::to_string(bus::Link::kLongRange))
      entry.problem("link", "expected short_range or long_range, found '" + link + "'");
    if (link == bus::to_string(bus::Link::kLongRange)) blackout.link = bus::Link::kLongRange;
    entry.read("from", blackout.from);
    entry.read("until", blackout.until);
    if (!(blackout.from >= 0.0 && blackout.until > blackout.from))
      entry.problem("until", "expected 0 <= from < until, in s since the start");
    if (entry.has("agent")) {
      entry.read("agent", agent);
      const auto id = AgentId::parse(agent);
      if (!id) entry.problem("agent", id.error().message);
      if (id) blackout.agent = *id;
    }
    entry.finish();
    blackouts.push_back(blackout);
  }
}

}  // namespace

void read_network(Section& top, bus::LocalNetworkConfig& network, std::vector<RadioBlackout>& blackouts) {
  Section section = top.section("network");
  read_radio(section, "long_range", network.long_range);
  read_radio(section, "short_range", network.short_range);
  section.read("seed", network.seed);
  read_blackouts(section, blackouts);
  section.finish();
  section.check(network.validate());
}

}  // namespace fleetmap::config
