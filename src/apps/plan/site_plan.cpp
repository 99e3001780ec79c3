#include "site_plan.hpp"

#include <filesystem>
#include <ostream>
#include <string>
#include <utility>

#include "drawn_site.hpp"
#include "fleet_to_plan.hpp"
#include "options.hpp"
#include "plan_files.hpp"
#include "plan_summary.hpp"
#include "robot/mission_setup.hpp"

namespace fleetmap::apps {
namespace {

CommandResult<FleetToPlan> fleet_of(const PlanOptions& options) {
  const auto overrides = parse_overrides(options.set);
  if (!overrides) return exit_with(kUsage, overrides.error());
  std::error_code error;
  if (!std::filesystem::is_regular_file(options.site, error)) {
    return exit_with(kBadConfiguration,
                     {options.site + ": no such file; give the GeoJSON drawing of a site"});
  }
  auto fleet = fleet_to_plan(options.site, options.config, options.agents.value_or(1), *overrides);
  if (!fleet) return exit_with(kBadConfiguration, fleet.error());
  if (options.agents && *options.agents > fleet->robots.size()) {
    return exit_with(kUsage,
                     {"--agents " + std::to_string(*options.agents) + ": " + options.config + " has only " +
                      std::to_string(fleet->robots.size()) + " robots; give at most so many"});
  }
  if (options.agents) fleet->robots.resize(*options.agents);
  return std::move(*fleet);
}

}  // namespace

CommandResult<ExitCode> plan_site(const PlanOptions& options, std::ostream& out) {
  auto fleet = fleet_of(options);
  if (!fleet) return tl::unexpected(fleet.error());
  const auto site = read_site(options.site, fleet->origin);
  if (!site) return exit_with(kBadConfiguration, site.error());
  const auto plan = plan_on(site->mission, std::move(fleet->robots), fleet->settings);
  if (!plan) return exit_with(kBadConfiguration, {options.site + ": " + plan.error().message});
  print_plan(out, **plan, *site);
  if (options.out.empty()) return kDone;
  const auto picture = write_plan(**plan, *site, options.out);
  if (!picture) return exit_with(kFailed, picture.error());
  out << "written to " << options.out << " and " << picture->string() << '\n';
  return kDone;
}

}  // namespace fleetmap::apps
