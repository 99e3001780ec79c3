#include <algorithm>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>

#include "commands.hpp"
#include "fleetmap/agent/navigator.hpp"
#include "fleetmap/config/experiment_file.hpp"
#include "fleetmap/config/file_kind.hpp"
#include "fleetmap/config/fleet_agreement.hpp"
#include "fleetmap/config/fleet_file.hpp"
#include "fleetmap/config/override.hpp"
#include "fleetmap/config/robot_file.hpp"
#include "fleetmap/config/world_file.hpp"
#include "fleetmap/experiment/case.hpp"
#include "mission_setup.hpp"
#include "network_check.hpp"
#include "options.hpp"
#include "twin_setup.hpp"

namespace fleetmap::apps {
namespace {

struct CheckOptions {
  std::string file;
  std::vector<std::string> set;
  std::optional<std::size_t> agents;
  bool network = false;
  NetworkCheckOptions radios;
};

/// Checks and describes a fleet's file. For a fleet of the twin it also builds the world and plans the
/// mission from the robots' starts.
Result<std::string> check_fleet(const std::string& file, const std::vector<config::Override>& overrides,
                                const std::optional<std::size_t>& agents) {
  auto fleet = config::load_fleet(file, overrides);
  if (!fleet) return tl::unexpected(fleet.error());
  if (agents) fleet->keep_first(std::min(*agents, fleet->members.size()));
  if (!fleet->twin) return std::string("a valid fleet configuration");
  const auto setup = set_up_twin(*fleet);
  if (!setup) return tl::unexpected(setup.error());
  std::ostringstream text;
  text << "a valid fleet configuration of the twin: " << fleet->members.size() << " robots, "
       << setup->plan->mission.rows.size() << " rows, planned to be driven in " << std::fixed
       << std::setprecision(0) << setup->plan->completion << " s";
  return text.str();
}

Result<std::string> check_robot(const std::string& file, const std::vector<config::Override>& overrides) {
  auto robot = config::load_robot(file, overrides);
  if (!robot) return tl::unexpected(robot.error());
  if (const Status planned = plan_mission(*robot); !planned) return tl::unexpected(planned.error());
  for (const std::string& warning : config::peer_warnings(robot->dds, robot->agent.exchange))
    std::cerr << file << ": warning: " << warning << '\n';
  if (!robot->mission) return std::string("a valid agent configuration");
  const planning::FleetPlan& plan = *robot->agent.navigator->plan;
  std::ostringstream text;
  text << "a valid agent configuration with a mission: " << plan.fleet.size() << " robots, "
       << plan.mission.rows.size() << " rows, planned to be driven in " << std::fixed << std::setprecision(0)
       << plan.completion << " s";
  return text.str();
}

Result<std::string> check(const std::string& file, const std::vector<config::Override>& overrides,
                          const std::optional<std::size_t>& agents) {
  const auto kind = config::check(file, overrides);
  if (!kind) return tl::unexpected(kind.error());
  switch (*kind) {
    case config::FileKind::kFleet:
      return check_fleet(file, overrides, agents);
    case config::FileKind::kWorld: {
      const auto world = config::make_world(file);
      if (!world) return tl::unexpected(world.error());
      return "a valid world with " + std::to_string((*world)->aisles().size()) + " lanes";
    }
    case config::FileKind::kSensor:
      return std::string("a valid sensor");
    case config::FileKind::kExperiment: {
      const auto experiment = config::load_experiment(file, false);
      if (!experiment) return tl::unexpected(experiment.error());
      const Status valid = experiment::check_cases(experiment::all_cases(*experiment));
      if (!valid) return tl::unexpected(valid.error());
      return "a valid experiment with " + std::to_string(experiment->studies.size()) + " studies";
    }
    case config::FileKind::kRobot:
      break;
  }
  return check_robot(file, overrides);
}

int run_network_check(const CheckOptions& options, const std::vector<config::Override>& overrides) {
  const auto kind = config::check(options.file, overrides);
  if (!kind) return report(kind.error(), kBadConfiguration);
  if (*kind != config::FileKind::kRobot)
    return report({options.file + ": --network needs the file of one robot"}, kUsage);
  const auto robot = config::load_robot(options.file, overrides);
  if (!robot) return report(robot.error(), kBadConfiguration);
  if (options.radios.domains.first > options.radios.domains.second)
    return report({"--domains: the first must not be above the last"}, kUsage);
  const auto fine = check_network(*robot, options.radios);
  if (!fine) return report(fine.error(), kFailed);
  return *fine ? kDone : kFailed;
}

int run(const CheckOptions& options) {
  const auto overrides = parse_overrides(options.set);
  if (!overrides) return report(overrides.error(), kUsage);
  if (options.network) return run_network_check(options, *overrides);
  const auto checked = check(options.file, *overrides, options.agents);
  if (!checked) return report(checked.error(), kBadConfiguration);
  std::cout << options.file << ": " << *checked << '\n';
  return kDone;
}

}  // namespace

void add_check_config(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* command = app.add_subcommand(
      "check-config", "says what a YAML file is and what is wrong with it, file:line by line");
  command->add_option("file", options->file, "FLEET.yaml, AGENT.yaml, WORLD.yaml, an experiment or a sensor")
      ->required();
  command->add_option("--set", options->set, "key=value, overrides any configuration key")
      ->allow_extra_args(false);
  command->add_option("--agents", options->agents, "only the first N agents of a fleet's file")
      ->check(whole_number(1));
  CLI::Option* network = command->add_flag(
      "--network", options->network,
      "a robot's file: listens on its radios and says who is heard, who is not and what differs; 1 if so");
  command->add_option("--seconds", options->radios.seconds, "s, to listen")
      ->needs(network)
      ->check(positive_number());
  command
      ->add_option("--domains", options->radios.domains,
                   "FIRST LAST: DDS domains in which robots that are not heard are looked for")
      ->needs(network)
      ->check(CLI::Range(0, 230));
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace fleetmap::apps
