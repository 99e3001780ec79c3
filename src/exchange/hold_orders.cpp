#include "fleetmap/exchange/hold_orders.hpp"

#include <algorithm>
#include <array>
#include <sstream>

namespace fleetmap::exchange {
namespace {

constexpr Duration kRepeatPeriod = std::chrono::seconds(10);
/// An agent that was silent for so long may have missed an order.
constexpr Duration kAbsence = std::chrono::seconds(8);
constexpr const char* kEverybody = "*";
using Kind = HoldOrder::Kind;
/// From the weakest to the strongest at equal stamps, and their names in the store.
constexpr std::array kKinds{Kind::kResume, Kind::kHome, Kind::kHold};
constexpr std::array<const char*, kKinds.size()> kNames{"resume", "home", "hold"};

std::size_t index_of(Kind kind) {
  return static_cast<std::size_t>(std::ranges::find(kKinds, kind) - kKinds.begin());
}

std::optional<HoldOrder> order_of(const std::string& line) {
  std::istringstream text(line);
  std::int64_t ns = 0;
  std::string robot, issuer, name;
  if (!(text >> ns >> robot >> issuer >> name)) return std::nullopt;
  const auto by = AgentId::parse(issuer);
  const auto whom = robot == kEverybody ? Result<AgentId>(AgentId{}) : AgentId::parse(robot);
  const auto known = std::ranges::find(kNames, name);
  if (!by || !whom || known == kNames.end()) return std::nullopt;
  return HoldOrder{stamp_from_ns(ns), *whom, *by, kKinds[static_cast<std::size_t>(known - kNames.begin())]};
}

}  // namespace

bool replaces(const HoldOrder& a, const HoldOrder& b) {
  return a.stamp != b.stamp ? a.stamp > b.stamp : index_of(a.kind) > index_of(b.kind);
}

std::optional<HoldOrder> order_for(const AgentId& robot, const std::vector<HoldOrder>& orders) {
  std::optional<HoldOrder> latest;
  for (const HoldOrder& order : orders) {
    if (!order.robot.empty() && order.robot != robot) continue;
    if (!latest || replaces(order, *latest)) latest = order;
  }
  return latest;
}

bool HoldOrders::add(const HoldOrder& order) {
  if (!order.robot.empty() && !fleet_.contains(order.robot)) return false;
  const auto [entry, fresh] = registers_.try_emplace(order.robot, order);
  if (!fresh && !replaces(order, entry->second)) return false;
  entry->second = order;
  due_ = true;
  return true;
}

bool HoldOrders::add(const RowOrder& order) {
  if (!fleet_.contains(order.robot) || (!order.to.empty() && !fleet_.contains(order.to))) return false;
  if (!rows_.add(order)) return false;
  due_ = true;
  return true;
}

bool HoldOrders::lacks_any(const Hold& theirs) const {
  return rows_.more_than(theirs.rows) || std::ranges::any_of(registers_, [&](const auto& entry) {
           const auto same = std::ranges::find(theirs.orders, entry.first, &HoldOrder::robot);
           return same == theirs.orders.end() || replaces(entry.second, *same);
         });
}

bool HoldOrders::on_hold(const Hold& hold) {
  bool changed = false;
  for (const HoldOrder& order : hold.orders) changed |= add(order);
  for (const RowOrder& order : hold.rows) changed |= add(order);
  // An operator waits for the robots to confirm, each time it sends the order.
  if (!fleet_.contains(hold.from) || lacks_any(hold)) due_ = true;
  return changed;
}

void HoldOrders::on_heard(const AgentId& agent, Stamp now) {
  const auto [last, fresh] = heard_.try_emplace(agent, now);
  if (!none() && (fresh || now - last->second > kAbsence)) due_ = true;
  last->second = now;
}

bool HoldOrders::tick(Stamp now) {
  const bool repeat = !none() && (!next_ || now >= *next_);
  if (!due_ && !repeat) return false;
  due_ = false;
  next_ = now + kRepeatPeriod;
  return true;
}

std::vector<HoldOrder> HoldOrders::all() const {
  std::vector<HoldOrder> orders;
  for (const auto& [robot, order] : registers_) orders.push_back(order);
  return orders;
}

bool HoldOrders::held() const {
  const auto order = in_force();
  return order && order->kind == Kind::kHold;
}

Bytes HoldOrders::encoded() const {
  std::ostringstream text;
  for (const auto& [robot, order] : registers_) {
    text << to_ns(order.stamp) << ' ' << (robot.empty() ? kEverybody : robot.str()) << ' '
         << order.issuer.str() << ' ' << kNames[index_of(order.kind)] << '\n';
  }
  for (const RowOrder& order : rows_.all()) text << RowOrders::line_of(order) << '\n';
  const std::string whole = text.str();
  return {whole.begin(), whole.end()};
}

void HoldOrders::load(ByteView encoded) {
  std::istringstream text(std::string(encoded.begin(), encoded.end()));
  for (std::string line; std::getline(text, line);) {
    if (const auto order = order_of(line)) {
      add(*order);
    } else if (const auto row = RowOrders::order_of(line)) {
      add(*row);
    }
  }
}

}  // namespace fleetmap::exchange
