#include "operator_order.hpp"

#include <functional>
#include <iostream>

#include "options.hpp"
#include "robot/live_bus.hpp"

namespace fleetmap::apps {
namespace {

using messages::Hold;
using messages::HoldOrder;
using messages::RowOrder;

const char* what_it_does(Hold::Driving driving) {
  switch (driving) {
    case Hold::Driving::kHeld:
      return "stands";
    case Hold::Driving::kFree:
      return "drives on";
    case Hold::Driving::kHome:
      return "drives home";
    case Hold::Driving::kNoMission:
      return "heard it, but fleetmap does not drive it";
    case Hold::Driving::kNoRobot:
      break;
  }
  return "heard it";
}

CommandResult<ExitCode> send(const bus::DdsBusConfig& dds, AddressedOrder addressed, double timeout,
                             std::ostream& out) {
  auto bus = join_dds(dds);
  if (!bus) return exit_with(kBadConfiguration, bus.error());
  std::visit([&](auto& one) { one.stamp = (*bus)->now(); }, addressed.order);
  const std::atomic<bool>& stop = stop_on_signals();
  const OrderInForce in_force(**bus, addressed.robots, addressed.order);
  (*bus)->run_until([&] { return stop || in_force.confirmed_by_all(); }, from_seconds(timeout));
  bool all = true;
  for (const AgentId& robot : addressed.robots) {
    const auto confirmed = in_force.confirmed().find(robot);
    if (confirmed != in_force.confirmed().end()) {
      out << robot.str() << ' ' << what_it_does(confirmed->second) << '\n';
      continue;
    }
    all = false;
    std::cerr << robot.str() << " did not confirm within " << timeout
              << " s: it is off, out of reach, or another operator orders otherwise; robots that heard the "
                 "order pass it on\n";
  }
  return all ? kDone : kFailed;
}

using MakeOrder = std::function<Result<AddressedOrder>(const OperatorFleet& fleet)>;

CommandResult<ExitCode> make_and_send(const OrderOptions& options, const MakeOrder& make, std::ostream& out) {
  const auto overrides = parse_overrides(options.set);
  if (!overrides) return exit_with(kUsage, overrides.error());
  const auto fleet = operator_fleet(options.config, *overrides);
  if (!fleet) return exit_with(kBadConfiguration, fleet.error());
  auto order = make(*fleet);
  if (!order) return exit_with(kUsage, order.error());
  return send(fleet->dds, std::move(*order), options.timeout, out);
}

}  // namespace

Result<AddressedOrder> driving_order(const OperatorFleet& fleet, const OrderOptions& options,
                                     HoldOrder::Kind kind) {
  HoldOrder order{{}, {}, fleet.dds.agent, kind};
  if (options.robot.empty()) return AddressedOrder{fleet.robots, order};
  const auto robot = robot_named(fleet, options.robot, options.config);
  if (!robot) return tl::unexpected(robot.error());
  order.robot = *robot;
  return AddressedOrder{{*robot}, order};
}

Result<AddressedOrder> row_order(const OperatorFleet& fleet, const OrderOptions& options) {
  const auto robot = robot_named(fleet, options.robot, options.config);
  if (!robot) return tl::unexpected(robot.error());
  RowOrder order{{}, *robot, {}, fleet.dds.agent, options.row};
  std::vector<AgentId> addressed{*robot};
  if (!options.to.empty()) {
    const auto to = robot_named(fleet, options.to, options.config);
    if (!to) return tl::unexpected(to.error());
    order.to = *to;
    if (*to != *robot) addressed.push_back(*to);
  }
  return AddressedOrder{std::move(addressed), order};
}

CommandResult<ExitCode> order_driving(const OrderOptions& options, HoldOrder::Kind kind, std::ostream& out) {
  return make_and_send(
      options, [&](const OperatorFleet& fleet) { return driving_order(fleet, options, kind); }, out);
}

CommandResult<ExitCode> order_row(const OrderOptions& options, std::ostream& out) {
  return make_and_send(
      options, [&](const OperatorFleet& fleet) { return row_order(fleet, options); }, out);
}

}  // namespace fleetmap::apps
