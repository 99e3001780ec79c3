#pragma once

#include <cstddef>
#include <vector>

#include "fleetmap/messages/messages.hpp"

namespace fleetmap::orders {

/// The orders of a large fleet divided among messages of at most `max_orders` orders (2 or more). Each has
/// the order for all and the one for `self`, so that its receiver sees in any of them what `self` obeys. If
/// they are several, each has exactly `max_orders` orders, so that the receiver of a full message does not
/// conclude that `self` lacks an order that is not in it. One message without orders if there are none.
std::vector<std::vector<messages::HoldOrder>> hold_parts(const std::vector<messages::HoldOrder>& orders,
                                                         const AgentId& self, std::size_t max_orders);

}  // namespace fleetmap::orders
