#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "commands.hpp"
#include "fleetmap/config/world_file.hpp"
#include "options.hpp"
#include "world_files.hpp"

namespace fleetmap::apps {
namespace {

struct WorldOptions {
  std::string file;
  std::string out;
  std::optional<std::uint64_t> seed;
  WorldFiles files;
};

int make(const WorldOptions& options) {
  const auto spec = config::load_world(options.file);
  if (!spec) return report(spec.error(), kBadConfiguration);
  const auto world = config::make_world(options.file, options.seed);
  if (!world) return report(world.error(), kBadConfiguration);
  describe_world(std::cout, **world);
  if (options.out.empty()) return kDone;
  WorldFiles settings = options.files;
  settings.seed = options.seed.value_or(settings.seed);
  if (const Status written = write_world(std::cout, **world, options.out, settings); !written)
    return report(written.error(), kFailed);
  return kDone;
}

}  // namespace

void add_world(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<WorldOptions>();
  CLI::App* command =
      app.add_subcommand("world", "make a world of the twin: its mesh and ground-truth points");
  command->add_option("file", options->file, "WORLD.yaml")->required();
  command
      ->add_option("--out", options->out,
                   "folder for world.ply, world.obj, truth.ply and site.geojson; else it is only described")
      ->check(some_path());
  command->add_option("--seed", options->seed, "instead of the file's")->check(whole_number(0));
  command
      ->add_option("--map-error", options->files.map_error,
                   "m, by which site.geojson, the drawing of the site for a mission, is off")
      ->check(non_negative_number());
  command->add_option("--density", options->files.density, "ground-truth points per m^2 of surface")
      ->check(positive_number());
  command->add_option("--max-points", options->files.max_points, "ground-truth points at most")
      ->check(whole_number(1, 200'000'000));
  command->callback([options, &exit_code] { exit_code = make(*options); });
}

}  // namespace fleetmap::apps
