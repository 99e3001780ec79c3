// `fleetmap map diff`: what changed on a site between two days.
#include <iostream>
#include <memory>

#include "day_comparison.hpp"
#include "map_subcommands.hpp"
#include "validators.hpp"

namespace fleetmap::apps {

void add_map_diff(CLI::App& map, int& exit_code) {
  auto options = std::make_shared<DiffOptions>();
  CLI::App* command =
      map.add_subcommand("diff", "what appeared and disappeared between two days, where both have looked");
  command->add_option("before", options->before, "store.db of the first day, maybe of map merge")->required();
  command->add_option("after", options->after, "store.db of the second day")->required();
  command->add_option("--geojson", options->geojson, "FILE.geojson of the changes, in WGS84")
      ->check(some_path());
  command->add_option("--ply", options->ply, "FILE.ply of both days' surfaces, coloured")->check(some_path());
  command->callback([options, &exit_code] { exit_code = report(compare_days(*options, std::cout)); });
}

}  // namespace fleetmap::apps
