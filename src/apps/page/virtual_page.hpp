#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <vector>

#include "fleetmap/agent/agent.hpp"
#include "fleetmap/bus/local_network.hpp"
#include "fleetmap/monitor/server.hpp"
#include "live_publisher.hpp"

namespace fleetmap::apps {

/// The live page of a fleet in virtual time: shows the first robot that is switched on as that robot's own
/// page would, and gives its orders to it. Used on the fleet's thread.
class VirtualPage {
 public:
  /// A robot that is switched on.
  struct Shown {
    agent::Agent* agent = nullptr;
    bus::Bus* bus = nullptr;
  };

  /// Both outlive this.
  VirtualPage(bus::LocalNetwork& network, monitor::Server& server) : network_(network), server_(server) {}

  /// To be called once a second of virtual time: carries out the orders since the last call, and publishes.
  void update(const std::vector<Shown>& fleet);
  /// Before any agent goes.
  void forget_agents();

 private:
  struct Order {
    std::uint64_t generation = 0;
    std::function<void()> carry_out;
  };
  void show(const Shown& robot);
  void carry_out_orders();
  std::vector<bus::HeardTraffic> take_heard(const AgentId& robot);

  bus::LocalNetwork& network_;
  monitor::Server& server_;
  LivePublisher::LastHeard last_heard_;
  std::mutex mutex_;           ///< of `orders_`, which the server's thread adds to
  std::vector<Order> orders_;  ///< those of a former generation are for an agent that is gone
  std::uint64_t generation_ = 0;
  std::optional<LivePublisher> publisher_;  ///< of the robot shown
};

}  // namespace fleetmap::apps
