#pragma once

#include <array>
#include <optional>
#include <vector>

#include "fleetmap/agent/agent.hpp"
#include "fleetmap/bus/dds_bus.hpp"
#include "fleetmap/monitor/server.hpp"
#include "link_log.hpp"
#include "radio_rates.hpp"

namespace fleetmap::apps {

/// Publishes a robot's live status to its page, and passes on the orders that viewers give. Used on the bus's
/// callback thread.
class LivePublisher {
 public:
  /// All outlive this. `keys`: the robot has those of its fleet.
  LivePublisher(agent::Agent& agent, bus::DdsBus& bus, monitor::Server& server, bool keys);
  ~LivePublisher();
  LivePublisher(const LivePublisher&) = delete;
  LivePublisher& operator=(const LivePublisher&) = delete;

  /// To be called once a second, with the traffic since the last call.
  void publish(const std::vector<bus::HeardTraffic>& heard, const LinkLog& log);

 private:
  monitor::RadioNow radio(const std::vector<bus::HeardTraffic>& heard);
  std::vector<monitor::SensorNow> sensors();

  agent::Agent& agent_;
  bus::DdsBus& bus_;
  monitor::Server& server_;
  bool keys_;
  RadioRates rates_;
  std::array<std::uint64_t, sensor::kSources> samples_{};  ///< at the last call
  std::optional<Stamp> published_;
};

}  // namespace fleetmap::apps
