#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "commands.hpp"
#include "drawn_site.hpp"
#include "fleet_to_plan.hpp"
#include "mission_setup.hpp"
#include "options.hpp"
#include "plan_files.hpp"
#include "plan_summary.hpp"

namespace fleetmap::apps {
namespace {

struct PlanOptions {
  std::string site;
  std::string config;
  std::string out;
  std::optional<std::size_t> agents;
  std::vector<std::string> set;
};

int run(const PlanOptions& options) {
  const auto overrides = parse_overrides(options.set);
  if (!overrides) return report(overrides.error(), kUsage);
  std::error_code error;
  if (!std::filesystem::is_regular_file(options.site, error))
    return report({options.site + ": no such file; give the GeoJSON drawing of a site"}, kBadConfiguration);
  auto fleet = fleet_to_plan(options.site, options.config, options.agents.value_or(1), *overrides);
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
  const auto picture = write_plan(**plan, *site, options.out);
  if (!picture) return report(picture.error(), kFailed);
  std::cout << "written to " << options.out << " and " << picture->string() << '\n';
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
