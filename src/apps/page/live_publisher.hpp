#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "fleetmap/agent/agent.hpp"
#include "fleetmap/bus/dds_bus.hpp"
#include "fleetmap/monitor/server.hpp"
#include "health/sensor_rates.hpp"
#include "map_progress.hpp"
#include "problem_log.hpp"
#include "robot/link_log.hpp"
#include "robot/radio_rates.hpp"

namespace fleetmap::apps {

/// Publishes a robot's live status to its page, and passes on the orders that viewers give. Used on the bus's
/// callback thread.
class LivePublisher {
 public:
  /// Runs its argument on the thread of the bus; false where it cannot.
  using Post = std::function<bool(std::function<void()>)>;
  /// All outlive this; `post` is called by the server's thread. `who_may_join`: as report.json states it.
  LivePublisher(agent::Agent& agent, bus::Bus& bus, monitor::Server& server, std::string who_may_join,
                const Post& post);
  ~LivePublisher();
  LivePublisher(const LivePublisher&) = delete;
  LivePublisher& operator=(const LivePublisher&) = delete;

  using LastHeard = std::map<LinkLog::Source, LinkLog::Heard>;
  /// To be called once a second, with the traffic since the last call. `others`: the agents of other robots
  /// that run in this process, whose problems are therefore known, too.
  void publish(const std::vector<bus::HeardTraffic>& heard, const LastHeard& last_heard,
               const std::vector<const agent::Agent*>& others = {});

 private:
  void add_findings(std::vector<monitor::SensorNow>& sensors) const;
  monitor::RadioNow radio(const std::vector<bus::HeardTraffic>& heard);

  agent::Agent& agent_;
  bus::Bus& bus_;
  monitor::Server& server_;
  std::string who_may_join_;
  RadioRates rates_;
  SensorRates sensors_;
  MapProgress progress_;
  ProblemLog problems_;
};

}  // namespace fleetmap::apps
