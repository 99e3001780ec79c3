#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "event_queue.hpp"
#include "fleetmap/bus/local_network.hpp"

namespace fleetmap::bus {

/// One copy of a message on its way from a robot to another.
struct Transmission {
  AgentId from;
  AgentId to;
  Topic topic;
  std::shared_ptr<const Bytes> cdr;
  Stamp published{};
};

/// The simulated medium: a queue per robot, one datagram in the air at a time, robots in turn.
class Radio {
 public:
  using Reachable = std::function<bool(const AgentId& from, const AgentId& to)>;
  using Deliver = std::function<void(const Transmission&)>;
  using Dropped = std::function<void(const Transmission&)>;

  Radio(Link link, const RadioConfig& config, std::uint64_t seed, EventQueue& events)
      : link_(link), config_(config), random_(seed), events_(events) {}

  void connect(Reachable reachable, Deliver deliver, Dropped dropped) {
    reachable_ = std::move(reachable);
    deliver_ = std::move(deliver);
    dropped_ = std::move(dropped);
  }
  const RadioConfig& config() const { return config_; }
  void send(Transmission transmission);
  void forget(const AgentId& agent) { waiting_.erase(agent); }
  std::vector<LinkUse> use() const;
  /// Copies that `to` had of each robot since the last call.
  std::vector<HeardCopies> take_heard(const AgentId& to);

 private:
  struct Attempt {
    std::size_t datagrams_sent = 0;
    bool arrived = true;
  };
  LinkUse& use_of(const Transmission& transmission);
  Attempt attempt(const Transmission& transmission);
  void start_next();
  void finish(const Transmission& transmission, bool arrived);

  Link link_;
  RadioConfig config_;
  std::mt19937_64 random_;
  EventQueue& events_;
  Reachable reachable_;
  Deliver deliver_;
  Dropped dropped_;
  std::map<AgentId, std::deque<Transmission>> waiting_;
  AgentId last_turn_;
  bool busy_ = false;
  std::map<std::pair<AgentId, std::string>, LinkUse> use_;
  std::map<AgentId, std::map<AgentId, HeardCopies>> heard_;  ///< by receiver and sender
};

}  // namespace fleetmap::bus
