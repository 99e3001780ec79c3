#include <iostream>
#include <memory>

#include "commands.hpp"
#include "site_plan.hpp"
#include "validators.hpp"

namespace fleetmap::apps {

void add_plan(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<PlanOptions>();
  CLI::App* command = app.add_subcommand("plan", "divides the rows of a site among robots, without driving");
  command->add_option("site", options->site, "SITE.geojson: rows, keep-outs, boundary, starts")->required();
  command->add_option("--agents", options->agents, "number of robots; with -c the first N of the file")
      ->check(whole_number(1, 100));
  command->add_option("-c,--config", options->config,
                      "AGENT.yaml with a mission, or FLEET.yaml: robots, settings and the site's origin");
  command->add_option("--out", options->out, "writes the plan as GeoJSON, and a picture of it beside (.png)")
      ->check(some_path());
  command->add_option("--set", options->set, "key=value, overrides any configuration key")
      ->allow_extra_args(false);
  command->callback([options, &exit_code] { exit_code = report(plan_site(*options, std::cout)); });
}

}  // namespace fleetmap::apps
