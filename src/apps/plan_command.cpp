#include <iomanip>
#include <iostream>
#include <memory>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>

#include "commands.hpp"
#include "drawn_site.hpp"
#include "fleetmap/config/file_kind.hpp"
#include "fleetmap/config/fleet_file.hpp"
#include "fleetmap/config/mission_settings.hpp"
#include "fleetmap/config/override.hpp"
#include "fleetmap/config/robot_config.hpp"
#include "fleetmap/config/robot_file.hpp"
#include "fleetmap/core/paths.hpp"
#include "fleetmap/core/whole_file.hpp"
#include "fleetmap/eval/colours.hpp"
#include "fleetmap/eval/picture.hpp"
#include "fleetmap/eval/png.hpp"
#include "fleetmap/planning/mission/plan_geojson.hpp"
#include "fleetmap/planning/site/geojson.hpp"
#include "mission_setup.hpp"
#include "options.hpp"
#include "plan_picture.hpp"
#include "plan_summary.hpp"
#include "twin_setup.hpp"

namespace fleetmap::apps {
namespace {

struct PlanOptions {
  std::string site;
  std::string config;
  std::string out;
  std::optional<std::size_t> agents;
  std::vector<std::string> set;
};

/// The fleet and its settings; without a file robots r1, r2, ... with default abilities.
struct FleetToPlan {
  planning::MissionConfig settings;
  std::vector<planning::RobotAbility> robots;
  std::optional<GeoPoint> origin;
};

constexpr double kDegree = std::numbers::pi / 180.0;

/// An agent's file may be planned with before it has the origin of ENU: then at the drawing's first position.
Result<config::RobotConfig> robot_of(const PlanOptions& options, std::vector<config::Override> overrides) {
  auto robot = config::load_robot(options.config, overrides);
  if (robot) return robot;
  const std::optional<GeoPoint> first = first_position_of(options.site);
  const GeoPoint origin = first.value_or(kSomewhere);
  std::ostringstream numbers;
  numbers << std::fixed << std::setprecision(7) << '[' << origin.latitude / kDegree << ", "
          << origin.longitude / kDegree << std::setprecision(1) << ", " << origin.altitude << ']';
  overrides.push_back({"site.origin", numbers.str()});
  robot = config::load_robot(options.config, overrides);
  if (!robot) return tl::unexpected(robot.error());
  std::cout << options.config << " has no site.origin, which the robots need to drive; planned about "
            << (first ? "the drawing's first position: site: {origin: " + numbers.str() +
                            "} with the true altitude would do, the same on every robot\n"
                      : std::string("any, since the drawing is in metres\n"));
  return robot;
}

Result<FleetToPlan> fleet_of(const PlanOptions& options, std::vector<config::Override> overrides) {
  const auto kind = options.config.empty() ? Result<config::FileKind>(config::FileKind::kFleet)
                                           : config::check(options.config, overrides);
  overrides.push_back({"mission.file", absolute_path(options.site).string()});
  if (options.config.empty()) {
    auto settings = config::load_mission_settings(overrides);
    if (!settings) return tl::unexpected(settings.error());
    FleetToPlan fleet{*settings, {}, std::nullopt};
    for (std::size_t k = 1; k <= options.agents.value_or(1); ++k) {
      planning::RobotAbility& robot = fleet.robots.emplace_back();
      robot.id = *AgentId::parse("r" + std::to_string(k));
      robot.speed = fleet.settings.speed;
    }
    return fleet;
  }
  if (!kind) return tl::unexpected(kind.error());
  if (*kind == config::FileKind::kFleet) {
    const auto config = config::load_fleet(options.config, overrides);
    if (!config) return tl::unexpected(config.error());
    return FleetToPlan{config->twin->mission, abilities_of(*config),
                       config->members.front().agent.site_origin};
  }
  if (*kind != config::FileKind::kRobot)
    return failure(options.config + ": give an agent's or a fleet's file");
  const auto robot = robot_of(options, overrides);
  if (!robot) return tl::unexpected(robot.error());
  return FleetToPlan{robot->mission->settings, robot->mission->fleet, robot->agent.site_origin};
}

Status write(const planning::FleetPlan& plan, const DrawnSite& site, const std::filesystem::path& out) {
  std::vector<std::string> colours;
  for (std::size_t k = 0; k < plan.fleet.size(); ++k) colours.push_back(eval::hex(eval::robot_colour(k)));
  const std::string text = planning::to_geojson(plan, colours, site.enu, site.frame);
  if (const Status written = write_whole_file(out, text); !written) return written;
  const auto image = picture_of(plan);
  if (!image) return tl::unexpected(image.error());
  const std::filesystem::path picture = std::filesystem::path(out).replace_extension(".png");
  if (const Status drawn = eval::write_png(picture, *image); !drawn) return drawn;
  std::cout << "written to " << out.string() << " and " << picture.string() << '\n';
  return {};
}

int run(const PlanOptions& options) {
  const auto overrides = parse_overrides(options.set);
  if (!overrides) return report(overrides.error(), kUsage);
  std::error_code error;
  if (!std::filesystem::is_regular_file(options.site, error))
    return report({options.site + ": no such file; give the GeoJSON drawing of a site"}, kBadConfiguration);
  auto fleet = fleet_of(options, *overrides);
  if (!fleet) return report(fleet.error(), kBadConfiguration);
  if (options.agents && *options.agents > fleet->robots.size()) {
    return report({"--agents " + std::to_string(*options.agents) + ": " + options.config + " has only " +
                   std::to_string(fleet->robots.size()) + " robots; give at most so many"},
                  kUsage);
  }
  if (options.agents) fleet->robots.resize(*options.agents);
  auto site = read_site(options.site, fleet->origin);
  if (!site) return report(site.error(), kBadConfiguration);
  const auto plan = plan_on(site->mission, std::move(fleet->robots), fleet->settings);
  if (!plan) return report({options.site + ": " + plan.error().message}, kBadConfiguration);
  print_plan(std::cout, **plan, *site);
  if (options.out.empty()) return kDone;
  if (const Status written = write(**plan, *site, options.out); !written)
    return report(written.error(), kFailed);
  return kDone;
}

}  // namespace

void add_plan(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<PlanOptions>();
  CLI::App* command = app.add_subcommand("plan", "divide the rows of a site among robots, without driving");
  command->add_option("site", options->site, "SITE.geojson: rows, keep-outs, boundary, starts")->required();
  command->add_option("--agents", options->agents, "number of robots; with -c the first so many of the file")
      ->check(whole_number(1, 100));
  command->add_option("-c,--config", options->config,
                      "AGENT.yaml with a mission, or FLEET.yaml: robots, settings and the site's origin");
  command->add_option("--out", options->out, "write the plan as GeoJSON, and a picture of it beside (.png)")
      ->check(some_path());
  command->add_option("--set", options->set, "key=value, overrides any configuration key")
      ->allow_extra_args(false);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace fleetmap::apps
