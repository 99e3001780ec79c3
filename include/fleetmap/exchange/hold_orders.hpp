#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/exchange/row_orders.hpp"
#include "fleetmap/messages/messages.hpp"

namespace fleetmap::exchange {

using messages::Hold;
using messages::HoldOrder;
using messages::RowOrder;

/// Whether order `a` replaces order `b` for the same robots. The later stamp wins; at equal stamps an order
/// to stop wins, else one to drive home.
bool replaces(const HoldOrder& a, const HoldOrder& b);
/// The order of `orders` that is in force for `robot`: the latest that names it or all; nothing without one.
std::optional<HoldOrder> order_for(const AgentId& robot, const std::vector<HoldOrder>& orders);

/// The operators' orders, replicated over the fleet: one last-writer-wins register for each robot and one for
/// all (stop, drive home, drive on), and one for each row that was given away (RowOrders). A robot sends its
/// registers when they change, to an operator that sends an order, to a robot that lacks one or that was
/// silent, and periodically; so a robot that missed an order receives it from any other. Without any order
/// nothing is sent.
class HoldOrders {
 public:
  HoldOrders(const AgentId& self, const std::set<AgentId>& fleet) : self_(self), fleet_(fleet) {}

  /// True if it replaced a register. Orders for robots that are not of the fleet are ignored.
  bool add(const HoldOrder& order);
  bool add(const RowOrder& order);
  /// True if a received order replaced a register.
  bool on_hold(const Hold& hold);
  /// A message of another robot of the fleet arrived.
  void on_heard(const AgentId& agent, Stamp now);
  /// The registers are to be sent with the next tick.
  void send_soon() { due_ = true; }
  /// True if the orders are to be sent now.
  bool tick(Stamp now);

  std::vector<HoldOrder> all() const;
  const RowOrders& rows() const { return rows_; }
  /// The order that this robot obeys.
  std::optional<HoldOrder> in_force() const { return order_for(self_, all()); }
  bool held() const;

  /// The registers as text, a line each, for the store; and back. Lines that cannot be read are left out.
  Bytes encoded() const;
  void load(ByteView encoded);

 private:
  bool none() const { return registers_.empty() && rows_.all().empty(); }
  bool lacks_any(const Hold& theirs) const;

  AgentId self_;
  std::set<AgentId> fleet_;
  std::map<AgentId, HoldOrder> registers_;  ///< by whom they are for; empty: all
  RowOrders rows_;
  std::map<AgentId, Stamp> heard_;
  bool due_ = false;
  std::optional<Stamp> next_;
};

}  // namespace fleetmap::exchange
