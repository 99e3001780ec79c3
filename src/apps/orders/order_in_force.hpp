#pragma once

#include <map>
#include <variant>
#include <vector>

#include "fleetmap/bus/dds_bus.hpp"
#include "fleetmap/orders/hold_orders.hpp"

namespace fleetmap::apps {

using Order = std::variant<messages::HoldOrder, messages::RowOrder>;

/// An operator's order on its way over the long range, and which robots confirmed it.
class OrderInForce {
 public:
  OrderInForce(bus::DdsBus& bus, std::vector<AgentId> addressed, const Order& order);

  bool confirmed_by_all() const { return confirmed_.size() == addressed_.size(); }
  const std::map<AgentId, messages::Hold::Driving>& confirmed() const { return confirmed_; }

 private:
  void send();
  /// Sends when another robot was found, and again from time to time.
  void repeat();
  void on_hold(const messages::Hold& hold);

  bus::DdsBus& bus_;
  std::vector<AgentId> addressed_;
  Order order_;
  std::map<AgentId, messages::Hold::Driving> confirmed_;
  std::size_t readers_ = 0;
  Stamp next_{};
  int renewals_ = 0;
  bus::Handle subscription_;
  bus::Handle timer_;
};

}  // namespace fleetmap::apps
