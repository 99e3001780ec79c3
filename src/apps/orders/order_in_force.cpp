#include "order_in_force.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <type_traits>
#include <utility>

#include "fleetmap/fleet_codec/messages.hpp"
#include "fleetmap/fleet_codec/topics.hpp"

namespace fleetmap::apps {
namespace {

using messages::Hold;
using messages::HoldOrder;
using messages::RowOrder;

constexpr Duration kRepeatPeriod = std::chrono::milliseconds(50);
constexpr Duration kRepeat = std::chrono::seconds(1);
/// Times that the order is repeated because a later one is in force. That one may come from a clock ahead of
/// this one; another operator may insist longer.
constexpr int kMaxRenewals = 3;

/// The robot that obeys `in_force` has heard of `order`, which robots complete (HoldOrders::give).
bool confirms(const HoldOrder& in_force, const HoldOrder& order) {
  return in_force.stamp == order.stamp && in_force.issuer == order.issuer;
}

bool confirms(const RowOrder& in_force, const RowOrder& order) { return in_force == order; }

/// The order that a robot which sent `hold` obeys in place of `order`; none if it has not heard of that.
std::optional<HoldOrder> obeyed(const HoldOrder& order, const Hold& hold) {
  const auto in_force = orders::order_for(hold.from, hold.orders);
  return in_force && !orders::replaces(order, *in_force) ? in_force : std::nullopt;
}

std::optional<RowOrder> obeyed(const RowOrder& order, const Hold& hold) {
  const auto same = std::ranges::find(hold.rows, order.row, &RowOrder::row);
  return same != hold.rows.end() && same->stamp >= order.stamp ? std::optional(*same) : std::nullopt;
}

/// The orders in `hold` that are of the kind of `order`.
template <class Order, class HoldMessage>
auto& orders_like(const Order& /*order*/, HoldMessage& hold) {
  if constexpr (std::is_same_v<Order, RowOrder>) {
    return hold.rows;
  } else {
    return hold.orders;
  }
}

}  // namespace

OrderInForce::OrderInForce(bus::DdsBus& bus, std::vector<AgentId> addressed, const Order& order)
    : bus_(bus), addressed_(std::move(addressed)), order_(order) {
  subscription_ = bus_.subscribe(fleet_codec::topics::hold(), [this](const Bytes& cdr) {
    if (const auto hold = fleet_codec::decode<Hold>(cdr)) on_hold(*hold);
  });
  bus_.advertise(fleet_codec::topics::hold());
  timer_ = bus_.every(kRepeatPeriod, [this] { repeat(); });
}

void OrderInForce::send() {
  next_ = bus_.now() + kRepeat;
  Hold hold;
  std::visit(
      [&](const auto& order) {
        hold.from = order.issuer;
        orders_like(order, hold).push_back(order);
      },
      order_);
  bus_.publish(fleet_codec::topics::hold(), fleet_codec::encode(hold));
}

void OrderInForce::repeat() {
  const std::size_t readers = bus_.matches(fleet_codec::topics::hold()).readers;
  if (readers > readers_ || (!confirmed_by_all() && bus_.now() >= next_)) send();
  readers_ = readers;
}

void OrderInForce::on_hold(const Hold& hold) {
  if (std::ranges::find(addressed_, hold.from) == addressed_.end()) return;
  std::visit(
      [&](auto& order) {
        const auto in_force = obeyed(order, hold);
        if (!in_force) return;
        if (confirms(*in_force, order)) {
          confirmed_[hold.from] = hold.driving;
        } else if (renewals_ < kMaxRenewals) {
          ++renewals_;
          order.stamp = orders::later_than(orders_like(order, hold), bus_.now());
          confirmed_.clear();
          send();
        }
      },
      order_);
}

}  // namespace fleetmap::apps
