// `fleetmap map diff`: what changed on a site between two days.
#include <iostream>
#include <memory>

#include "day_comparison.hpp"
#include "map_subcommands.hpp"
#include "validators.hpp"

namespace fleetmap::apps {

void add_map_diff(CLI::App& map, int& exit_code) {
  auto options = std::make_shared<DiffOptions>();
  CLI::App* command = map.add_subcommand(
      "diff", "finds objects that appeared or disappeared between two days, in places that both observed");
  command->add_option("before", options->before, "store.db of the first day; that of `map merge`, too")
      ->required();
  command->add_option("after", options->after, "store.db of the second day")->required();
  command->add_option("--geojson", options->geojson, "writes the changes to FILE.geojson, in WGS84")
      ->check(some_path());
  command->add_option("--ply", options->ply, "writes the surfaces of both days, coloured, to FILE.ply")
      ->check(some_path());
  command->callback([options, &exit_code] { exit_code = report(compare_days(*options, std::cout)); });
}

}  // namespace fleetmap::apps
