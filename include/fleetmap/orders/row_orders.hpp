#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/core/time.hpp"
#include "fleetmap/messages/messages.hpp"

namespace fleetmap::orders {

using messages::RowOrder;

/// The operators' orders to give rows away: one last-writer-wins register for each row. At most
/// messages::Hold::kMaxRows are kept, those with the latest stamps, so that every robot keeps the same ones
/// and they fit one message.
class RowOrders {
 public:
  /// True if it replaced a register.
  bool add(const RowOrder& order);
  /// Some row has a later order here than in `theirs`.
  bool more_than(const std::vector<RowOrder>& theirs) const;
  std::vector<RowOrder> all() const;

  /// One order as a line of text for the store, and back.
  static std::string line_of(const RowOrder& order);
  static std::optional<RowOrder> order_of(const std::string& line);

 private:
  std::map<std::uint32_t, RowOrder> registers_;  ///< by row
};

/// A stamp later than those of all `orders` (messages::HoldOrder or RowOrder), and not before `now`: an order
/// that carries it replaces them whatever the clocks of those who gave them.
template <class Order>
Stamp later_than(const std::vector<Order>& orders, Stamp now) {
  Stamp stamp = now;
  for (const Order& order : orders) stamp = std::max(stamp, order.stamp + Duration(1));
  return stamp;
}

}  // namespace fleetmap::orders
