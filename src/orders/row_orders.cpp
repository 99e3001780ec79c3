#include "fleetmap/orders/row_orders.hpp"

#include <algorithm>
#include <sstream>
#include <tuple>

namespace fleetmap::orders {
namespace {

constexpr const char* kAnyone = "*";
constexpr const char* kGive = "give";

/// A total order, so that all robots choose the same one of two that were given at once.
auto row_precedence(const RowOrder& order) {
  return std::tie(order.stamp, order.row, order.to, order.robot, order.issuer);
}

}  // namespace

bool RowOrders::add(const RowOrder& order) {
  const auto [entry, fresh] = registers_.try_emplace(order.row, order);
  if (!fresh && row_precedence(order) <= row_precedence(entry->second)) return false;
  entry->second = order;
  if (registers_.size() <= messages::Hold::kMaxRows) return true;
  const auto first = std::ranges::min_element(registers_, [](const auto& a, const auto& b) {
    return row_precedence(a.second) < row_precedence(b.second);
  });
  const bool kept = first->first != order.row;
  registers_.erase(first);
  return kept;
}

bool RowOrders::more_than(const std::vector<RowOrder>& theirs) const {
  return std::ranges::any_of(registers_, [&](const auto& entry) {
    const auto same = std::ranges::find(theirs, entry.first, &RowOrder::row);
    return same == theirs.end() || row_precedence(entry.second) > row_precedence(*same);
  });
}

std::vector<RowOrder> RowOrders::all() const {
  std::vector<RowOrder> orders;
  for (const auto& [row, order] : registers_) orders.push_back(order);
  return orders;
}

std::string RowOrders::line_of(const RowOrder& order) {
  std::ostringstream text;
  text << to_ns(order.stamp) << ' ' << order.robot.str() << ' ' << order.issuer.str() << ' ' << kGive << ' '
       << order.row << ' ' << (order.to.empty() ? kAnyone : order.to.str());
  return text.str();
}

std::optional<RowOrder> RowOrders::order_of(const std::string& line) {
  std::istringstream text(line);
  std::int64_t ns = 0;
  std::uint32_t row = 0;
  std::string robot, issuer, name, to;
  if (!(text >> ns >> robot >> issuer >> name >> row >> to) || name != kGive) return std::nullopt;
  const auto whose = AgentId::parse(robot), by = AgentId::parse(issuer);
  const auto whom = to == kAnyone ? Result<AgentId>(AgentId{}) : AgentId::parse(to);
  if (!whose || !by || !whom) return std::nullopt;
  return RowOrder{stamp_from_ns(ns), *whose, *whom, *by, row};
}

}  // namespace fleetmap::orders
