#include "hold_parts.hpp"

#include <algorithm>
#include <iterator>

namespace fleetmap::orders {

std::vector<std::vector<messages::HoldOrder>> hold_parts(const std::vector<messages::HoldOrder>& orders,
                                                         const AgentId& self, std::size_t max_orders) {
  if (orders.size() <= max_orders) return {orders};
  std::vector<messages::HoldOrder> in_each, rest;
  std::partition_copy(
      orders.begin(), orders.end(), std::back_inserter(in_each), std::back_inserter(rest),
      [&](const messages::HoldOrder& order) { return order.robot.empty() || order.robot == self; });
  const std::size_t step = max_orders - in_each.size();
  std::vector<std::vector<messages::HoldOrder>> parts;
  for (std::size_t begin = 0; begin < rest.size(); begin += step) {
    // The last part repeats some of the one before, to be full.
    const auto first = rest.begin() + static_cast<std::ptrdiff_t>(std::min(begin, rest.size() - step));
    parts.push_back(in_each);
    parts.back().insert(parts.back().end(), first, first + static_cast<std::ptrdiff_t>(step));
  }
  return parts;
}

}  // namespace fleetmap::orders
