#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "fleetmap/bus/bus.hpp"
#include "fleetmap/exchange/exchange.hpp"

namespace fleetmap::agent {

/// Refused messages, and times of the last traffic, on the bus's clock.
struct FleetLinkCounters {
  std::uint64_t refused_messages = 0;  ///< that could not be decoded: other version, damaged, hostile
  Stamp last_submap;  ///< when a piece of a submap last came or went, or a request for one came
  /// When a message last came that was more than "I am here", or went that was no mere request.
  Stamp last_useful;
};

/// Moves messages between the exchange's state machine and the bus.
class FleetLink {
 public:
  /// Both outlive this. `on_events` is called after every tick and message that may have made events.
  FleetLink(const AgentId& self, bus::Bus& bus, exchange::Exchange& exchange,
            std::function<void()> on_events);

  /// Hears and sends no more.
  void stop() { handles_.clear(); }
  /// Sends what is due.
  void tick();
  const FleetLinkCounters& counters() const { return counters_; }

 private:
  void receive(const bus::Topic& topic, const Bytes& cdr);

  bus::Bus& bus_;
  exchange::Exchange& exchange_;
  std::function<void()> on_events_;
  FleetLinkCounters counters_;
  std::uint64_t discovery_bytes_ = 0;  ///< of the long range, as of the last tick
  std::map<std::string, std::uint64_t> warned_;
  std::vector<bus::Handle> handles_;
};

}  // namespace fleetmap::agent
