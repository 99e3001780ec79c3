#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/messages/messages.hpp"
#include "fleetmap/orders/row_orders.hpp"

namespace fleetmap::orders {

using messages::Hold;
using messages::HoldOrder;
using messages::RowOrder;

/// Whether order `a` replaces order `b` for the same robots. The later stamp wins; at equal stamps an order
/// to stop wins, else one to drive home.
bool replaces(const HoldOrder& a, const HoldOrder& b);
/// The order of `orders` that is in force for `robot`: the latest that names it or all; nothing without one.
/// At equal stamps an order to stop wins, else the one that names the robot.
std::optional<HoldOrder> order_for(const AgentId& robot, const std::vector<HoldOrder>& orders);

/// The operators' orders, replicated over the fleet: one last-writer-wins register for each robot and one for
/// all (stop, drive home, drive on), and one for each row that was given away (RowOrders). A robot sends its
/// registers when they change, to an operator that sends an order, to a robot that lacks one or that was
/// silent, and periodically; so a robot that missed an order receives it from any other. Without any order
/// nothing is sent.
class HoldOrders {
 public:
  /// Orders to drive on whose stamps are not farther apart are one order, given repeatedly.
  static constexpr Duration kSameResume = std::chrono::seconds(60);
  static constexpr std::size_t kMaxInMessage = 32;  ///< orders that a Hold carries on a link

  HoldOrders(const AgentId& self, const std::set<AgentId>& fleet) : self_(self), fleet_(fleet) {}

  /// An operator's order as it was given. It is completed by the orders before it: one to hold keeps a call
  /// home in force, and one to drive on lets a robot that was held on its way home go on with that. A further
  /// one to drive on ends the call, but not within kSameResume of the last: operators repeat an order with a
  /// later stamp when a robot does not confirm it. True if it replaced a register. Orders for robots that are
  /// not of the fleet are ignored.
  bool give(const HoldOrder& order);
  bool give(const RowOrder& order) { return add(order); }
  /// Orders that another robot repeats, or that an operator gives. The other robot completed them; this one
  /// completes those for itself again, since the other one may not have heard that it was called home. True
  /// if one replaced a register.
  bool on_hold(const Hold& hold);
  /// A message of another robot of the fleet arrived.
  void on_heard(const AgentId& agent, Stamp now);
  /// The registers are to be sent with the next tick.
  void send_soon() { due_ = true; }
  /// True if the orders are to be sent now.
  bool tick(Stamp now);

  std::vector<HoldOrder> all() const;
  /// All orders, divided among messages that links carry (hold_parts).
  std::vector<std::vector<HoldOrder>> parts() const;
  const RowOrders& rows() const { return rows_; }
  /// The order that this robot obeys.
  std::optional<HoldOrder> in_force() const { return order_for(self_, all()); }
  bool held() const;

  /// The registers as text, a line each, for the store; and back. Lines that cannot be read are left out.
  Bytes encoded() const;
  void load(ByteView encoded);

 private:
  bool add(const HoldOrder& order);
  bool add(const RowOrder& order);
  /// `order` with the call home that `before` it was in force.
  HoldOrder completed(HoldOrder order, const std::optional<HoldOrder>& before) const;
  /// Whether `order` is a register to drive home that an order to drive on made.
  bool is_resumed(const HoldOrder& order) const;
  /// Whether the later `order` to drive on lets a robot that obeyed `before` drive home.
  bool goes_on_home(const HoldOrder& order, const HoldOrder& before) const;
  /// Adds `order`, which completed() has made of an order of kind `requested`.
  bool add_completed(const HoldOrder& order, HoldOrder::Kind requested);
  /// Completes the order that this robot obeys since another one repeated it; this robot obeyed `before`.
  bool complete_own(const std::optional<HoldOrder>& before);
  bool none() const { return registers_.empty() && rows_.all().empty(); }
  bool lacks_any(const Hold& theirs) const;

  AgentId self_;
  std::set<AgentId> fleet_;
  std::map<AgentId, HoldOrder> registers_;  ///< by whom they are for; empty: all
  std::map<AgentId, Stamp> resumed_;        ///< stamps of such registers (is_resumed), by whom they are for
  RowOrders rows_;
  std::map<AgentId, Stamp> heard_;
  bool due_ = false;
  std::optional<Stamp> next_;
};

}  // namespace fleetmap::orders
