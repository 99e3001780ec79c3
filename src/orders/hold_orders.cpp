#include "fleetmap/orders/hold_orders.hpp"

#include <algorithm>
#include <array>
#include <sstream>
#include <tuple>

#include "hold_parts.hpp"

namespace fleetmap::orders {
namespace {

constexpr Duration kRepeatPeriod = std::chrono::seconds(10);
/// An agent that was silent for so long may have missed an order.
constexpr Duration kAbsence = std::chrono::seconds(8);
constexpr const char* kEverybody = "*";
/// Ends the line of a register to drive home that an order to drive on made.
constexpr const char* kResumed = " resumed";
using Kind = HoldOrder::Kind;
/// From the weakest to the strongest at equal stamps, and their names in the store.
constexpr std::array kKinds{Kind::kResume, Kind::kHome, Kind::kHold, Kind::kHoldHome};
constexpr std::array<const char*, kKinds.size()> kNames{"resume", "home", "hold", "hold_home"};

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

/// Which order a robot obeys of those that name it or all.
auto precedence(const HoldOrder& order) {
  return std::tuple(order.stamp, order.stops(), !order.robot.empty(), index_of(order.kind));
}

}  // namespace

bool replaces(const HoldOrder& a, const HoldOrder& b) {
  return a.stamp != b.stamp ? a.stamp > b.stamp : index_of(a.kind) > index_of(b.kind);
}

std::optional<HoldOrder> order_for(const AgentId& robot, const std::vector<HoldOrder>& orders) {
  std::optional<HoldOrder> latest;
  for (const HoldOrder& order : orders) {
    if (!order.robot.empty() && order.robot != robot) continue;
    if (!latest || precedence(order) > precedence(*latest)) latest = order;
  }
  return latest;
}

bool HoldOrders::is_resumed(const HoldOrder& order) const {
  const auto resumed = resumed_.find(order.robot);
  return order.kind == Kind::kHome && resumed != resumed_.end() && resumed->second == order.stamp;
}

bool HoldOrders::goes_on_home(const HoldOrder& order, const HoldOrder& before) const {
  return before.kind == Kind::kHoldHome || (is_resumed(before) && order.stamp - before.stamp <= kSameResume);
}

HoldOrder HoldOrders::completed(HoldOrder order, const std::optional<HoldOrder>& before) const {
  if (!before) return order;
  if (order.kind == Kind::kHold && before->calls_home()) order.kind = Kind::kHoldHome;
  if (order.kind == Kind::kResume && goes_on_home(order, *before)) order.kind = Kind::kHome;
  return order;
}

bool HoldOrders::give(const HoldOrder& order) {
  const std::vector<HoldOrder> before = all();
  const HoldOrder whole = completed(order, order_for(order.robot, before));
  if (!order.robot.empty()) return add_completed(whole, order.kind);
  // A robot that alone was called home, or alone was let go, keeps a register of its own. All are completed
  // by the registers as they were before the order.
  std::vector<HoldOrder> registers{whole};
  for (const AgentId& robot : fleet_) {
    HoldOrder own = completed(order, order_for(robot, before));
    own.robot = robot;
    if (own.kind != whole.kind) registers.push_back(own);
  }
  bool changed = false;
  for (const HoldOrder& one : registers) changed |= add_completed(one, order.kind);
  return changed;
}

bool HoldOrders::add_completed(const HoldOrder& order, Kind requested) {
  if (!add(order)) return false;
  if (requested == Kind::kResume && order.kind == Kind::kHome) resumed_[order.robot] = order.stamp;
  return true;
}

bool HoldOrders::complete_own(const std::optional<HoldOrder>& before) {
  const auto repeated = in_force();
  if (!before || !repeated || repeated->stamp <= before->stamp) return false;
  // The other robot has completed it the same way.
  if (repeated->kind == Kind::kHome && goes_on_home(*repeated, *before))
    resumed_[repeated->robot] = repeated->stamp;
  HoldOrder own = completed(*repeated, before);
  if (own.kind == repeated->kind) return false;
  own.robot = self_;
  return add_completed(own, repeated->kind);
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
  // Others may follow a full message (hold_parts).
  const bool whole = theirs.orders.size() < kMaxInMessage;
  return rows_.more_than(theirs.rows) || std::ranges::any_of(registers_, [&](const auto& entry) {
           const auto same = std::ranges::find(theirs.orders, entry.first, &HoldOrder::robot);
           return same == theirs.orders.end() ? whole : replaces(entry.second, *same);
         });
}

bool HoldOrders::on_hold(const Hold& hold) {
  bool changed = false;
  const bool repeated = fleet_.contains(hold.from);
  const auto before = in_force();
  for (const HoldOrder& order : hold.orders) changed |= repeated ? add(order) : give(order);
  if (repeated) changed |= complete_own(before);
  for (const RowOrder& order : hold.rows) changed |= add(order);
  // An operator waits for the robots to confirm, each time it sends the order.
  if (!repeated || lacks_any(hold)) due_ = true;
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

std::vector<std::vector<HoldOrder>> HoldOrders::parts() const {
  return hold_parts(all(), self_, kMaxInMessage);
}

bool HoldOrders::held() const {
  const auto order = in_force();
  return order && order->stops();
}

Bytes HoldOrders::encoded() const {
  std::ostringstream text;
  for (const auto& [robot, order] : registers_) {
    text << to_ns(order.stamp) << ' ' << (robot.empty() ? kEverybody : robot.str()) << ' '
         << order.issuer.str() << ' ' << kNames[index_of(order.kind)] << (is_resumed(order) ? kResumed : "")
         << '\n';
  }
  for (const RowOrder& order : rows_.all()) text << RowOrders::line_of(order) << '\n';
  const std::string whole = text.str();
  return {whole.begin(), whole.end()};
}

void HoldOrders::load(ByteView encoded) {
  std::istringstream text(std::string(encoded.begin(), encoded.end()));
  for (std::string line; std::getline(text, line);) {
    if (const auto order = order_of(line)) {
      add_completed(*order, line.ends_with(kResumed) ? Kind::kResume : order->kind);
    } else if (const auto row = RowOrders::order_of(line)) {
      add(*row);
    }
  }
}

}  // namespace fleetmap::orders
