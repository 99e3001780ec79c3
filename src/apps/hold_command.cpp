// `fleetmap hold`, `resume`, `home` and `give`: an operator's order to one robot or to all, over the long
// range.
#include <algorithm>
#include <iostream>
#include <memory>

#include "commands.hpp"
#include "fleetmap/bus/dds_bus.hpp"
#include "fleetmap/config/file_kind.hpp"
#include "fleetmap/config/fleet_file.hpp"
#include "fleetmap/config/override.hpp"
#include "fleetmap/config/robot_file.hpp"
#include "fleetmap/exchange/hold_orders.hpp"
#include "fleetmap/fleet_codec/messages.hpp"
#include "fleetmap/fleet_codec/topics.hpp"
#include "live_bus.hpp"
#include "options.hpp"
#include "order_in_force.hpp"

namespace fleetmap::apps {
namespace {

using messages::Hold;
using messages::HoldOrder;
using messages::RowOrder;

struct HoldOptions {
  std::string config;
  std::string robot;
  std::string to;
  std::uint32_t row = 0;
  double timeout = 15.0;
  std::vector<std::string> set;
};

/// The robots that a command is sent to, and the DDS configuration that reaches them.
struct Fleet {
  std::vector<AgentId> robots;
  bus::DdsBusConfig dds;
};

Result<Fleet> fleet_of(const HoldOptions& options, const std::vector<config::Override>& overrides) {
  const auto kind = config::check(options.config, overrides);
  if (!kind) return tl::unexpected(kind.error());
  Fleet fleet;
  if (*kind == config::FileKind::kFleet) {
    auto loaded = config::load_fleet(options.config, overrides);
    if (!loaded) return tl::unexpected(loaded.error());
    for (const auto& member : loaded->members) fleet.robots.push_back(member.agent.id);
    fleet.dds = loaded->members.front().dds;
  } else if (*kind == config::FileKind::kRobot) {
    auto loaded = config::load_robot(options.config, overrides);
    if (!loaded) return tl::unexpected(loaded.error());
    fleet.robots = loaded->agent.exchange.fleet;
    fleet.dds = loaded->dds;
  } else {
    return failure(options.config + ": is no robot's and no fleet's configuration");
  }
  fleet.dds.agent = free_name("operator", fleet.robots);
  fleet.dds.settings.reset();
  fleet.dds.onboard.enabled = false;
  fleet.dds.short_range.enabled = false;
  bus::DdsLinkConfig& radio = fleet.dds.long_range;
  // A robot's file names the others; its own agent may run here.
  if (!radio.peers.empty()) radio.peers.push_back(radio.address.empty() ? "127.0.0.1" : radio.address);
  return fleet;
}

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

/// The robot of that name; fails if there is none.
Result<AgentId> member(const Fleet& fleet, const std::string& name, const std::string& file) {
  const auto found = std::ranges::find_if(fleet.robots, [&](const AgentId& id) { return id.str() == name; });
  return found == fleet.robots.end() ? failure(file + ": has no robot '" + name + "'")
                                     : Result<AgentId>(*found);
}

/// Sends the order until all robots that it concerns have confirmed it.
int send(const Fleet& fleet, const HoldOptions& options, std::vector<AgentId> addressed, Order order) {
  auto bus = join_dds(fleet.dds);
  if (!bus) return report(bus.error(), kBadConfiguration);
  std::visit([&](auto& one) { one.stamp = (*bus)->now(); }, order);
  const std::atomic<bool>& stop = stop_on_signals();
  const OrderInForce in_force(**bus, addressed, order);
  (*bus)->run_until([&] { return stop || in_force.confirmed_by_all(); }, from_seconds(options.timeout));
  bool all = true;
  for (const AgentId& robot : addressed) {
    const auto confirmed = in_force.confirmed().find(robot);
    if (confirmed != in_force.confirmed().end()) {
      std::cout << robot.str() << ' ' << what_it_does(confirmed->second) << '\n';
      continue;
    }
    all = false;
    std::cerr << robot.str() << " did not confirm within " << options.timeout
              << " s: it is off, out of reach, or another operator orders otherwise; robots that heard the "
                 "order pass it on\n";
  }
  return all ? kDone : kFailed;
}

int drive(const HoldOptions& options, HoldOrder::Kind kind) {
  const auto overrides = parse_overrides(options.set);
  if (!overrides) return report(overrides.error(), kUsage);
  const auto fleet = fleet_of(options, *overrides);
  if (!fleet) return report(fleet.error(), kBadConfiguration);
  HoldOrder order{{}, {}, fleet->dds.agent, kind};
  std::vector<AgentId> addressed = fleet->robots;
  if (!options.robot.empty()) {
    const auto robot = member(*fleet, options.robot, options.config);
    if (!robot) return report(robot.error(), kUsage);
    addressed = {*robot};
    order.robot = *robot;
  }
  return send(*fleet, options, addressed, order);
}

int give(const HoldOptions& options) {
  const auto overrides = parse_overrides(options.set);
  if (!overrides) return report(overrides.error(), kUsage);
  const auto fleet = fleet_of(options, *overrides);
  if (!fleet) return report(fleet.error(), kBadConfiguration);
  const auto robot = member(*fleet, options.robot, options.config);
  if (!robot) return report(robot.error(), kUsage);
  RowOrder order{{}, *robot, {}, fleet->dds.agent, options.row};
  std::vector<AgentId> addressed{*robot};
  if (!options.to.empty()) {
    const auto to = member(*fleet, options.to, options.config);
    if (!to) return report(to.error(), kUsage);
    order.to = *to;
    if (*to != *robot) addressed.push_back(*to);
  }
  return send(*fleet, options, addressed, order);
}

CLI::App* add_order(CLI::App& app, const char* name, const char* about,
                    const std::shared_ptr<HoldOptions>& options) {
  CLI::App* command = app.add_subcommand(name, about);
  command->add_option("-c,--config", options->config, "AGENT.yaml of any robot, or FLEET.yaml")->required();
  command->add_option("--robot", options->robot, "this robot alone")->check(some_path());
  command->add_option("--timeout", options->timeout, "s, to wait until every robot has confirmed")
      ->check(positive_number());
  command->add_option("--set", options->set, "key=value, overrides any configuration key")
      ->allow_extra_args(false);
  return command;
}

}  // namespace

void add_hold(CLI::App& app, int& exit_code) {
  using Kind = HoldOrder::Kind;
  const auto add = [&](const char* name, const char* about, Kind kind) {
    const auto options = std::make_shared<HoldOptions>();
    add_order(app, name, about, options)->callback([options, kind, &exit_code] {
      exit_code = drive(*options, kind);
    });
  };
  add("hold", "one robot or all stand still until resume, over the long range", Kind::kHold);
  add("resume", "one robot or all, held or called home before, drive on", Kind::kResume);
  add("home", "one robot or all give their rows away and drive to their starts until resume", Kind::kHome);
  const auto options = std::make_shared<HoldOptions>();
  CLI::App* command = add_order(app, "give", "a robot gives a row of the mission to another one", options);
  command->get_option("--robot")->required()->description("the robot that is not to drive the row");
  command->add_option("--row", options->row, "id of the row, as the mission's file has it")->required();
  command->add_option("--to", options->to, "the robot that is to drive it; else any other one")
      ->check(some_path());
  command->callback([options, &exit_code] { exit_code = give(*options); });
}

}  // namespace fleetmap::apps
