#include "order_in_force.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "fleetmap/fleet_codec/messages.hpp"
#include "fleetmap/fleet_codec/topics.hpp"

namespace fleetmap::apps {
namespace {

using messages::Hold;
using messages::HoldOrder;

constexpr Duration kCheckPeriod = std::chrono::milliseconds(50);
constexpr Duration kRepeat = std::chrono::seconds(1);
/// Times that the order is repeated because a later one is in force. That one may come from a clock ahead of
/// this one; another operator may insist longer.
constexpr int kMaxRenewals = 3;

}  // namespace

OrderInForce::OrderInForce(bus::DdsBus& bus, std::vector<AgentId> addressed, const HoldOrder& order)
    : bus_(bus), addressed_(std::move(addressed)), order_(order) {
  subscription_ = bus_.subscribe(fleet_codec::topics::hold(), [this](const Bytes& cdr) {
    if (const auto hold = fleet_codec::decode<Hold>(cdr)) on_hold(*hold);
  });
  bus_.advertise(fleet_codec::topics::hold());
  timer_ = bus_.every(kCheckPeriod, [this] { repeat(); });
}

void OrderInForce::send() {
  next_ = bus_.now() + kRepeat;
  bus_.publish(fleet_codec::topics::hold(),
               fleet_codec::encode(Hold{order_.issuer, Hold::Driving::kNoRobot, {order_}}));
}

void OrderInForce::repeat() {
  const std::size_t readers = bus_.matches(fleet_codec::topics::hold()).readers;
  if (readers > readers_ || (!confirmed_by_all() && bus_.now() >= next_)) send();
  readers_ = readers;
}

void OrderInForce::on_hold(const Hold& hold) {
  if (std::ranges::find(addressed_, hold.from) == addressed_.end()) return;
  const auto in_force = exchange::order_for(hold.from, hold.orders);
  if (!in_force || exchange::replaces(order_, *in_force)) return;  // it has not heard
  if (*in_force == order_) {
    confirmed_[hold.from] = hold.driving;
  } else if (renewals_ < kMaxRenewals) {
    ++renewals_;
    order_.stamp = exchange::later_than(hold.orders, bus_.now());
    confirmed_.clear();
    send();
  }
}

}  // namespace fleetmap::apps
