#include <fstream>
#include <iomanip>
#include <iostream>
#include <iterator>
#include <memory>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>

#include "commands.hpp"
#include "fleetmap/config/file_kind.hpp"
#include "fleetmap/config/fleet_file.hpp"
#include "fleetmap/config/mission_settings.hpp"
#include "fleetmap/config/override.hpp"
#include "fleetmap/config/robot_config.hpp"
#include "fleetmap/config/robot_file.hpp"
#include "fleetmap/eval/picture.hpp"
#include "fleetmap/planning/geojson.hpp"
#include "mission_setup.hpp"
#include "options.hpp"
#include "plan_picture.hpp"
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

std::string text_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// An agent's file may be planned with before it has the origin of ENU: then at the drawing's first position.
Result<config::RobotConfig> robot_of(const PlanOptions& options, std::vector<config::Override> overrides) {
  auto robot = config::load_robot(options.config, overrides);
  if (robot) return robot;
  const std::optional<GeoPoint> first = planning::first_position(text_of(options.site));
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
  overrides.push_back({"mission.file", std::filesystem::absolute(options.site).string()});
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

/// The drawing, the frame of its file, and the ENU frame that it is planned in.
struct Site {
  planning::Mission mission;
  planning::FileFrame frame = planning::FileFrame::kWgs84;
  LocalFrame enu{kSomewhere};
};

Result<Site> read_site(const std::string& file, const std::optional<GeoPoint>& origin) {
  const std::optional<GeoPoint> first = planning::first_position(text_of(file));
  Site site;
  site.frame = first ? planning::FileFrame::kWgs84 : planning::FileFrame::kEnu;
  site.enu = LocalFrame(origin.value_or(first.value_or(kSomewhere)));
  auto mission = planning::read_geojson(file, site.enu);
  if (!mission) return tl::unexpected(mission.error());
  site.mission = std::move(*mission);
  return site;
}

std::string place_text(const Eigen::Vector2d& p, const Site& site) {
  const bool enu = site.frame == planning::FileFrame::kEnu;
  const GeoPoint geo = site.enu.to_geo({p.x(), p.y(), 0.0});
  std::ostringstream text;
  text << std::fixed << std::setprecision(enu ? 1 : 6) << (enu ? p.x() : geo.latitude / kDegree) << ", "
       << (enu ? p.y() : geo.longitude / kDegree)
       << (enu ? " m (east, north)" : " deg (latitude, longitude)");
  return text.str();
}

void print(const planning::FleetPlan& plan, const Site& site) {
  std::cout << std::fixed << std::setprecision(0);
  for (const planning::RobotRoute& route : plan.division.routes) {
    std::cout << route.agent.str() << ": " << route.visits.size() << " rows, " << route.length << " m, "
              << route.time << " s:";
    for (const planning::RowVisit& visit : route.visits)
      std::cout << ' ' << visit.row << (visit.reversed ? " (from its end)" : "");
    std::cout << '\n';
  }
  if (!plan.division.left_out.empty()) {
    std::cout << "left out, since no battery reaches them:";
    for (const planning::RowId row : plan.division.left_out) std::cout << ' ' << row;
    std::cout << '\n';
  }
  if (plan.meeting) {
    std::cout << "all meet at " << place_text(plan.meeting->place, site) << " after " << plan.meeting->latest
              << " s; all maps are exchanged after " << plan.completion << " s\n";
  } else {
    std::cout << "all rows are driven after " << plan.completion << " s\n";
  }
}

Status write(const planning::FleetPlan& plan, const Site& site, const std::filesystem::path& out) {
  std::vector<std::string> colours;
  for (std::size_t k = 0; k < plan.fleet.size(); ++k) colours.push_back(eval::hex(eval::robot_colour(k)));
  std::ofstream file(out, std::ios::binary);
  file << planning::to_geojson(plan, colours, site.enu, site.frame);
  file.flush();
  if (!file) return failure(out.string() + ": cannot be written; check the folder and free space");
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
  print(**plan, *site);
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
