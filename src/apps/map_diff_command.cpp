// `fleetmap map diff`: what changed on a site between two days.
#include <iostream>
#include <memory>
#include <string>

#include "commands.hpp"
#include "day_changes.hpp"
#include "fleetmap/change/change_files.hpp"
#include "fleetmap/core/whole_file.hpp"
#include "map_subcommands.hpp"
#include "options.hpp"

namespace fleetmap::apps {
namespace {

struct DiffOptions {
  std::string before, after;
  std::string geojson, ply;
};

int diff(const DiffOptions& options) {
  const auto compared = changes_between(options.before, options.after);
  if (!compared) return report(compared.error(), kFailed);
  print_changes(std::cout, *compared);
  if (!options.ply.empty()) {
    if (const Status written = change::write_coloured(options.ply, compared->changes); !written)
      return report(written.error(), kFailed);
  }
  if (options.geojson.empty()) return kDone;
  if (!compared->origin)
    return report({options.geojson + ": neither day has GPS, so nobody knows where on Earth the changes are"},
                  kFailed);
  const Status written =
      write_whole_file(options.geojson, change::to_geojson(compared->changes, *compared->origin));
  return written ? kDone : report(written.error(), kFailed);
}

}  // namespace

void add_map_diff(CLI::App& map, int& exit_code) {
  auto options = std::make_shared<DiffOptions>();
  CLI::App* command =
      map.add_subcommand("diff", "what appeared and disappeared between two days, where both have looked");
  command->add_option("before", options->before, "store.db of the first day, maybe of map merge")->required();
  command->add_option("after", options->after, "store.db of the second day")->required();
  command->add_option("--geojson", options->geojson, "FILE.geojson of the changes, in WGS84")
      ->check(some_path());
  command->add_option("--ply", options->ply, "FILE.ply of both days' surfaces, coloured")->check(some_path());
  command->callback([options, &exit_code] { exit_code = diff(*options); });
}

}  // namespace fleetmap::apps
