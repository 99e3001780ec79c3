#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <queue>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "fleetmap/exchange/exchange.hpp"
#include "store/items.hpp"

namespace fleetmap::testing {

using exchange::Message;

/// Bytes of a message as agents publish it.
std::size_t payload_size(const Message& message);

/// A fleet of exchanges on a network that loses, delays, reorders and doubles messages, in virtual time.
class SimFleet {
 public:
  struct Network {
    double loss = 0.0;
    double duplication = 0.0;
    Duration min_delay = std::chrono::milliseconds(5);
    Duration max_delay = std::chrono::milliseconds(60);
  };
  struct Sent {
    Stamp at;
    AgentId from;
    exchange::Outgoing outgoing;
    std::size_t wire_bytes;
  };
  struct Robot {
    std::unique_ptr<store::Store> store;
    std::unique_ptr<exchange::Exchange> exchange;
    std::uint16_t session = 0;
    std::vector<exchange::Event> events;
    std::map<NodeId, Bytes> clouds;  ///< made for peers
    std::vector<exchange::CloudArrived> arrived;
  };

  SimFleet(const std::vector<std::string>& names, const Network& network, std::uint32_t seed,
           const std::function<void(exchange::ExchangeConfig&)>& adjust = {});

  /// Of those that start from now on: these alone are on their radio.
  void share_radio(std::span<const std::string> names);
  /// Goes on with the file that the robot left, in session `session`.
  void start(const std::string& name, std::uint16_t session = 0);
  /// As kill -9 does: memory is gone, the file stays.
  void kill(const std::string& name) { robots_.erase(agent(name)); }
  /// Of a robot that is not running: its file as it is now, and back to what it was then (nothing: none).
  void keep_store(const std::string& name);
  void put_back_store(const std::string& name);
  void lose_store(const std::string& name);
  Robot& robot(const std::string& name) { return robots_.at(agent(name)); }
  const std::map<AgentId, Robot>& robots() const { return robots_; }

  graph::Node add_node(const std::string& name, double east_m, std::size_t submap_bytes = 3000);
  void add_alignment(const std::string& name, const exchange::NodePair& pair, double rmse);

  /// `reachable(from, to, link)`: by default everyone hears everyone on the long-range link, nobody on the
  /// other.
  std::function<bool(const AgentId&, const AgentId&, exchange::Reach)> reachable =
      [](const AgentId&, const AgentId&, exchange::Reach reach) {
        return reach == exchange::Reach::kLongRange;
      };
  /// RMSE of the registration of a pair, nothing when it is rejected.
  std::function<std::optional<double>(const exchange::NodePair&)> registration =
      [](const exchange::NodePair&) { return std::optional(0.2); };
  std::size_t cloud_bytes = 24'000;
  bool register_clouds = true;

  void run_for(Duration time, const std::function<bool()>& until = {});
  void step();

  Stamp now() const { return now_; }
  const std::vector<Sent>& sent() const { return sent_; }
  void forget_sent() { sent_.clear(); }
  const exchange::ExchangeConfig& config() const { return config_; }
  bool all(const std::function<bool(const Robot&)>& holds) const;
  /// Every running robot holds the same nodes and alignments, and `nodes` of them.
  bool equal_sets(std::size_t nodes) const;

 private:
  struct Flight {
    Stamp at;
    std::uint64_t order;
    AgentId to;
    exchange::Reach reach;
    std::shared_ptr<const Message> message;
    bool operator>(const Flight& other) const {
      return std::tie(at, order) > std::tie(other.at, other.order);
    }
  };

  void send(const AgentId& from, const exchange::Outgoing& outgoing, const Robot& robot);
  void react(const AgentId& name, Robot& robot, const exchange::Event& event);

  ScratchFolder folder_;
  Network network_;
  std::mt19937 random_;
  exchange::ExchangeConfig config_;
  Stamp now_ = stamp_from_ns(1'700'000'000'000'000'000);
  std::map<AgentId, Robot> robots_;
  std::priority_queue<Flight, std::vector<Flight>, std::greater<>> in_flight_;
  std::uint64_t order_ = 0;
  std::vector<Sent> sent_;
};

}  // namespace fleetmap::testing
