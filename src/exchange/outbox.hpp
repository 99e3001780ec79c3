#pragma once

#include <set>
#include <vector>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/exchange/exchange_config.hpp"
#include "fleetmap/exchange/send_queue.hpp"
#include "fleetmap/messages/routing.hpp"

namespace fleetmap::exchange {

using messages::Message;
using messages::Outgoing;

/// Chooses the link of each message: the short range for robots that are near (NeighbourTable::is_near), the
/// radio for the others.
class Outbox {
 public:
  Outbox(const AgentId& self, const ExchangeConfig& config);

  /// The radio's queue.
  SendQueue& queue() { return queue_; }
  const SendQueue& queue() const { return queue_; }

  /// Robots that the next messages are for: `near` ones over the short range, and those `present` on the
  /// radio. Returns whether a robot has become near.
  bool set_receivers(std::set<AgentId> near, std::set<AgentId> present);
  const std::set<AgentId>& near() const { return near_; }

  /// Sends to all others. Orders go over both links, since an operator may hear either.
  void broadcast(Priority priority, Message message);
  /// Sends to all robots that are near.
  void push_near(Message message) { to_near_.push_back(std::move(message)); }
  /// Removes and returns what goes over the short range now: messages to all near robots, and those in the
  /// radio's queue that are for one of them.
  std::vector<Outgoing> take_short_range();

 private:
  AgentId self_;
  std::set<AgentId> on_radio_, elsewhere_;  ///< members on this robot's radio, and the others
  SendQueue queue_;
  std::set<AgentId> near_;
  std::set<AgentId> present_;
  std::vector<Message> to_near_;
};

/// A message over the short range, to the recipient that it names.
Outgoing over_short_range(Message message);

}  // namespace fleetmap::exchange
