// `fleetmap hold` and `fleetmap resume`: an operator's order to one robot or to all, over the long range.
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

struct HoldOptions {
  std::string config;
  std::string robot;
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
    case Hold::Driving::kNoMission:
      return "heard it, but fleetmap does not drive it";
    case Hold::Driving::kNoRobot:
      break;
  }
  return "heard it";
}

int run(const HoldOptions& options, bool hold) {
  const auto overrides = parse_overrides(options.set);
  if (!overrides) return report(overrides.error(), kUsage);
  const auto fleet = fleet_of(options, *overrides);
  if (!fleet) return report(fleet.error(), kBadConfiguration);
  HoldOrder order{{}, {}, fleet->dds.agent, hold};
  std::vector<AgentId> addressed = fleet->robots;
  if (!options.robot.empty()) {
    std::erase_if(addressed, [&](const AgentId& id) { return id.str() != options.robot; });
    if (addressed.empty()) return report({options.config + ": has no robot '" + options.robot + "'"}, kUsage);
    order.robot = addressed.front();
  }
  auto bus = join_dds(fleet->dds);
  if (!bus) return report(bus.error(), kBadConfiguration);
  order.stamp = (*bus)->now();
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

void add_order(CLI::App& app, int& exit_code, bool hold) {
  auto options = std::make_shared<HoldOptions>();
  CLI::App* command =
      hold ? app.add_subcommand("hold", "one robot or all stand still until resume, over the long range")
           : app.add_subcommand("resume", "one robot or all, held before, drive on");
  command->add_option("-c,--config", options->config, "AGENT.yaml of any robot, or FLEET.yaml")->required();
  command->add_option("--robot", options->robot, "this robot alone")->check(some_path());
  command->add_option("--timeout", options->timeout, "s, to wait until every robot has confirmed")
      ->check(positive_number());
  command->add_option("--set", options->set, "key=value, overrides any configuration key")
      ->allow_extra_args(false);
  command->callback([options, hold, &exit_code] { exit_code = run(*options, hold); });
}

}  // namespace

void add_hold(CLI::App& app, int& exit_code) {
  add_order(app, exit_code, true);
  add_order(app, exit_code, false);
}

}  // namespace fleetmap::apps
