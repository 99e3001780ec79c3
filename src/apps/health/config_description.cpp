#include "config_description.hpp"

#include <algorithm>
#include <iomanip>
#include <iostream>
#include <sstream>

#include "fleetmap/agent/navigator.hpp"
#include "fleetmap/config/experiment_file.hpp"
#include "fleetmap/config/file_kind.hpp"
#include "fleetmap/config/fleet_agreement.hpp"
#include "fleetmap/config/fleet_file.hpp"
#include "fleetmap/config/robot_file.hpp"
#include "fleetmap/config/world_file.hpp"
#include "fleetmap/experiment/case.hpp"
#include "local_files.hpp"
#include "robot/mission_setup.hpp"
#include "twin/twin_setup.hpp"

namespace fleetmap::apps {
namespace {

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
  if (const Status local = check_local_files(robot->agent); !local)
    return failure(file + ": " + local.error().message);
  if (const Status planned = plan_mission(*robot); !planned) return tl::unexpected(planned.error());
  if (const auto warning = write_warning(robot->agent.directory))
    std::cerr << file << ": warning: " << *warning << '\n';
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

}  // namespace

Result<std::string> describe_config(const std::string& file, const std::vector<config::Override>& overrides,
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

}  // namespace fleetmap::apps
