#include <filesystem>
#include <iomanip>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "commands.hpp"
#include "evaluation.hpp"
#include "options.hpp"

namespace fleetmap::apps {
namespace {

struct EvalOptions {
  std::string directory;
  EvaluationInputs inputs;
  bool no_pictures = false;
  std::vector<std::string> modes{"all"};
  bool no_overlap = false;
};

void print_map(const nlohmann::json& map) {
  std::cout << "map: " << map["map_points"] << " points, " << map["mapped_area"].get<double>() << " m^2, "
            << map["mean_density"].get<double>() << " points within " << map["density_radius"] << " m\n";
  if (!map.contains("rmse")) return;
  const auto percent = [&](const char* key, std::size_t k) { return 100.0 * map[key][k].get<double>(); };
  std::cout << "    RMSE " << map["rmse"].get<double>() << " m, fitness " << map["fitness"].get<double>()
            << ", det(C) " << map["det_covariance"] << ", Chamfer " << map["chamfer"].get<double>() << " m\n"
            << "    within 5 / 10 / 20 cm: accuracy " << percent("accuracy", 0) << " / "
            << percent("accuracy", 1) << " / " << percent("accuracy", 2) << " %, completeness "
            << percent("completeness", 0) << " / " << percent("completeness", 1) << " / "
            << percent("completeness", 2) << " %\n";
}

void print_fleet(const nlohmann::json& evaluation) {
  if (evaluation.contains("alignments")) {
    const auto& alignments = evaluation["alignments"];
    std::cout << "alignments: " << alignments["count"] << " judged, " << alignments["wrong"] << " wrong, "
              << alignments["ambiguous"] << " ambiguous, " << alignments["used"] << " used, of these "
              << alignments["wrong_used"] << " wrong\n";
  }
  if (evaluation.contains("fleet")) {
    const auto& fleet = evaluation["fleet"];
    std::cout << "fleet: joint ATE " << fleet["ate_joint"].get<double>() << " m (between robots "
              << fleet["between_robots"].get<double>() << ", bends " << fleet["bend"].get<double>()
              << "), unaligned " << fleet["ate_unaligned"].get<double>() << " m\n";
  }
}

void print_modes(const nlohmann::json& modes) {
  for (const auto& [mode, one] : modes.items()) {
    if (!one.contains("fleet")) continue;
    std::cout << one["registration"].get<std::string>() << " registration, "
              << one["placement"].get<std::string>() << " placement: joint ATE "
              << one["fleet"]["ate_joint"].get<double>() << " m, " << one["alignments"]["wrong"] << " of "
              << one["alignments"]["count"] << " alignments wrong, " << one["alignments"]["wrong_used"]
              << " of them used, " << one["fleet"]["wrong_merges"] << " wrong merges\n";
  }
}

void print_summary(const std::string& directory, const nlohmann::json& evaluation) {
  std::cout << std::setprecision(4);
  if (evaluation.contains("map")) print_map(evaluation["map"]);
  print_fleet(evaluation);
  if (evaluation.contains("modes")) print_modes(evaluation["modes"]);
  for (const auto& [id, agent] : evaluation["agents"].items()) {
    if (!agent.contains("ate_rmse")) continue;
    std::cout << id << ": ATE " << agent["ate_rmse"].get<double>() << " m, aligned "
              << agent["ate_rmse_aligned"].get<double>() << " m, over " << agent["path_length"].get<double>()
              << " m\n";
  }
  for (const auto& pair : evaluation["pairs"]) {
    std::cout << pair["a"].get<std::string>() << " - " << pair["b"].get<std::string>()
              << ": relative position " << pair["translation_rmse"].get<double>() << " m\n";
  }
  for (const auto& note : evaluation["notes"]) std::cout << "note: " << note.get<std::string>() << '\n';
  std::cout << "evaluation: " << directory << "/evaluation.html\n";
}

/// Of the map or of a trajectory.
bool measured_anything(const nlohmann::json& evaluation) {
  if (evaluation.contains("map") || evaluation.contains("fleet") || !evaluation["pairs"].empty()) return true;
  for (const nlohmann::json& agent : evaluation["agents"]) {
    if (!agent.empty()) return true;
  }
  return false;
}

/// What --modes may name.
std::set<std::string> mode_choices() {
  std::set<std::string> choices = mode_names();
  choices.insert({"all", "none"});
  return choices;
}

int run(EvalOptions& options) {
  options.inputs.pictures = !options.no_pictures;
  options.inputs.modes = {options.modes.begin(), options.modes.end()};
  if (options.inputs.modes.contains("all")) options.inputs.modes = mode_names();
  options.inputs.modes.erase("none");
  options.inputs.overlap = !options.no_overlap;
  std::error_code error;
  if (std::filesystem::is_directory(options.directory, error)) {
    if (const Status writable = check_writable(options.directory); !writable)
      return report(writable.error(), kFailed);
  }
  const auto evaluation = evaluate_run(options.directory, options.inputs);
  if (!evaluation) return report(evaluation.error(), kFailed);
  print_summary(options.directory, *evaluation);
  if (!measured_anything(*evaluation))
    return report({options.directory + ": nothing could be measured, see the notes"}, kFailed);
  return kDone;
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
  command->add_flag("--no-pictures", options->no_pictures, "numbers only");
  command
      ->add_option("--modes", options->modes,
                   "combinations of registration and placement to evaluate beside the run's own, which is "
                   "most of the time")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember(mode_choices()))
      ->capture_default_str();
  command->add_flag("--register-again", options->inputs.register_again,
                    "register the run's encounters anew with this program, by the run's own method too: what "
                    "another version of fleetmap would have made of the same clouds");
  command->add_flag("--no-overlap", options->no_overlap, "not what two robots saw");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace fleetmap::apps
