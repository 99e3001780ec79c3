#include <iostream>
#include <memory>

#include "commands.hpp"
#include "validators.hpp"
#include "world_making.hpp"

namespace fleetmap::apps {

void add_world(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<WorldOptions>();
  CLI::App* command =
      app.add_subcommand("world", "makes a world of the twin: its mesh and ground-truth points");
  command->add_option("file", options->file, "WORLD.yaml")->required();
  command
      ->add_option(
          "--out", options->out,
          "folder for world.ply, world.obj, truth.ply and site.geojson; else a description is printed")
      ->check(some_path());
  command->add_option("--seed", options->seed, "seed instead of the file's")->check(whole_number(0));
  command
      ->add_option("--map-error", options->files.map_error,
                   "m, error of site.geojson, the drawing of the site for a mission")
      ->check(non_negative_number());
  command->add_option("--density", options->files.density, "ground-truth points per m^2 of surface")
      ->check(positive_number());
  command->add_option("--max-points", options->files.max_points, "maximum number of ground-truth points")
      ->check(whole_number(1, 200'000'000));
  command->callback([options, &exit_code] { exit_code = report(make_world(*options, std::cout)); });
}

}  // namespace fleetmap::apps
