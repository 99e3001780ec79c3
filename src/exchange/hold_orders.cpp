#include "fleetmap/exchange/hold_orders.hpp"

#include <algorithm>
#include <sstream>

namespace fleetmap::exchange {
namespace {

constexpr Duration kRepeatPeriod = std::chrono::seconds(10);
/// An agent that was silent for so long may have missed an order.
constexpr Duration kAbsence = std::chrono::seconds(8);
constexpr const char* kEverybody = "*";

}  // namespace

bool replaces(const HoldOrder& a, const HoldOrder& b) {
  return a.stamp != b.stamp ? a.stamp > b.stamp : a.hold && !b.hold;
}

std::optional<HoldOrder> order_for(const AgentId& robot, const std::vector<HoldOrder>& orders) {
  std::optional<HoldOrder> latest;
  for (const HoldOrder& order : orders) {
    if (!order.robot.empty() && order.robot != robot) continue;
    if (!latest || replaces(order, *latest)) latest = order;
  }
  return latest;
}

Stamp later_than(const std::vector<HoldOrder>& orders, Stamp now) {
  Stamp stamp = now;
  for (const HoldOrder& order : orders) stamp = std::max(stamp, order.stamp + Duration(1));
  return stamp;
}

bool HoldOrders::add(const HoldOrder& order) {
  if (!order.robot.empty() && !fleet_.contains(order.robot)) return false;
  const auto [entry, fresh] = registers_.try_emplace(order.robot, order);
  if (!fresh && !replaces(order, entry->second)) return false;
  entry->second = order;
  due_ = true;
  return true;
}

bool HoldOrders::lacks_any(const std::vector<HoldOrder>& theirs) const {
  return std::ranges::any_of(registers_, [&](const auto& entry) {
    const auto same = std::ranges::find(theirs, entry.first, &HoldOrder::robot);
    return same == theirs.end() || replaces(entry.second, *same);
  });
}

bool HoldOrders::on_hold(const Hold& hold) {
  bool changed = false;
  for (const HoldOrder& order : hold.orders) changed |= add(order);
  // An operator waits for the robots to confirm, each time it sends the order.
  if (!fleet_.contains(hold.from) || lacks_any(hold.orders)) due_ = true;
  return changed;
}

void HoldOrders::on_heard(const AgentId& agent, Stamp now) {
  const auto [last, fresh] = heard_.try_emplace(agent, now);
  if (!registers_.empty() && (fresh || now - last->second > kAbsence)) due_ = true;
  last->second = now;
}

std::optional<std::vector<HoldOrder>> HoldOrders::tick(Stamp now) {
  const bool repeat = !registers_.empty() && (!next_ || now >= *next_);
  if (!due_ && !repeat) return std::nullopt;
  due_ = false;
  next_ = now + kRepeatPeriod;
  return all();
}

std::vector<HoldOrder> HoldOrders::all() const {
  std::vector<HoldOrder> orders;
  for (const auto& [robot, order] : registers_) orders.push_back(order);
  return orders;
}

bool HoldOrders::held() const {
  const auto order = in_force();
  return order && order->hold;
}

Bytes HoldOrders::encoded() const {
  std::ostringstream text;
  for (const auto& [robot, order] : registers_) {
    text << to_ns(order.stamp) << ' ' << (robot.empty() ? kEverybody : robot.str()) << ' '
         << order.issuer.str() << ' ' << (order.hold ? "hold" : "resume") << '\n';
  }
  const std::string whole = text.str();
  return {whole.begin(), whole.end()};
}

void HoldOrders::load(ByteView encoded) {
  std::istringstream text(std::string(encoded.begin(), encoded.end()));
  std::int64_t ns = 0;
  std::string robot, issuer, what;
  while (text >> ns >> robot >> issuer >> what) {
    const auto by = AgentId::parse(issuer);
    const auto whom = robot == kEverybody ? Result<AgentId>(AgentId{}) : AgentId::parse(robot);
    if (by && whom && (what == "hold" || what == "resume"))
      add({stamp_from_ns(ns), *whom, *by, what == "hold"});
  }
}

}  // namespace fleetmap::exchange
