#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <set>
#include <string>

#include "commands.hpp"
#include "run_measurement.hpp"

namespace fleetmap::apps {
namespace {

/// Values that --modes accepts.
std::set<std::string> mode_choices() {
  std::set<std::string> choices = run_evaluation::mode_names();
  choices.insert({"all", "none"});
  return choices;
}

}  // namespace

void add_eval(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<EvalOptions>();
  CLI::App* command = app.add_subcommand("eval", "measures a run's maps and trajectories against the truth");
  command->add_option("directory", options->directory, "the --out of fleetmap run")->required();
  command->add_option(
      "--truth", options->inputs.truth_file,
      "cloud (.ply, .pcd), mesh (.obj, .ply) or world (.yaml) in ENU of the run's origin; else "
      "truth.ply of the folder");
  command->add_option(
      "--truth-trajectories", options->inputs.truth_trajectories,
      "folder of NAME.tum or NAME/truth.tum, stamped like the run; else NAME/truth.tum of the "
      "run's folder");
  command->add_option("--inlier-distance", options->inputs.map.inlier_distance, "m, of Eq. 2 and Eq. 3")
      ->capture_default_str();
  command->add_option("--density-radius", options->inputs.map.density_radius, "m, r_d of Eq. 4")
      ->capture_default_str();
  command
      ->add_option("--max-map-points", options->inputs.max_map_points,
                   "of a larger map every k-th point is measured, which bounds memory")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_flag("--no-pictures", options->no_pictures, "writes numbers only");
  command
      ->add_option("--modes", options->modes,
                   "combinations of registration and placement to evaluate beside the run's own, which is "
                   "most of the time")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember(mode_choices()))
      ->capture_default_str();
  command->add_flag(
      "--register-again", options->inputs.register_again,
      "registers the run's loop candidates anew with this program, by the run's own method too, to "
      "compare versions of fleetmap on the same clouds");
  command->add_flag("--no-overlap", options->no_overlap, "does not measure the overlap of robots");
  command->callback([options, &exit_code] { exit_code = report(measure_run(*options, std::cout)); });
}

}  // namespace fleetmap::apps
