#include "fleetmap/run_evaluation/evaluation_summary.hpp"

#include <iomanip>
#include <nlohmann/json.hpp>
#include <string>

namespace fleetmap::run_evaluation {
namespace {

using nlohmann::json;

void print_map(std::ostream& out, const json& map) {
  out << "map: " << map["map_points"] << " points, " << map["mapped_area"].get<double>() << " m^2, "
      << map["mean_density"].get<double>() << " points within " << map["density_radius"] << " m\n";
  if (!map.contains("rmse")) return;
  const auto percent = [&](const char* key, std::size_t k) { return 100.0 * map[key][k].get<double>(); };
  out << "    RMSE " << map["rmse"].get<double>() << " m, fitness " << map["fitness"].get<double>()
      << ", det(C) " << map["det_covariance"] << ", Chamfer " << map["chamfer"].get<double>() << " m\n"
      << "    within 5 / 10 / 20 cm: accuracy " << percent("accuracy", 0) << " / " << percent("accuracy", 1)
      << " / " << percent("accuracy", 2) << " %, completeness " << percent("completeness", 0) << " / "
      << percent("completeness", 1) << " / " << percent("completeness", 2) << " %\n";
}

void print_fleet(std::ostream& out, const json& evaluation) {
  if (evaluation.contains("alignments")) {
    const auto& alignments = evaluation["alignments"];
    out << "alignments: " << alignments["count"] << " evaluated, " << alignments["wrong"] << " wrong, "
        << alignments["ambiguous"] << " ambiguous, " << alignments["used"] << " used, of these "
        << alignments["wrong_used"] << " wrong\n";
  }
  if (evaluation.contains("fleet")) {
    const auto& fleet = evaluation["fleet"];
    out << "fleet: joint ATE " << fleet["ate_joint"].get<double>() << " m (between robots "
        << fleet["between_robots"].get<double>() << ", within robots " << fleet["bend"].get<double>()
        << "), unaligned " << fleet["ate_unaligned"].get<double>() << " m\n";
  }
}

void print_modes(std::ostream& out, const json& modes) {
  for (const auto& [mode, one] : modes.items()) {
    if (!one.contains("fleet")) continue;
    out << one["registration"].get<std::string>() << " registration, " << one["placement"].get<std::string>()
        << " placement: joint ATE " << one["fleet"]["ate_joint"].get<double>() << " m, "
        << one["alignments"]["wrong"] << " of " << one["alignments"]["count"] << " alignments wrong, "
        << one["alignments"]["wrong_used"] << " of them used, " << one["fleet"]["wrong_merges"]
        << " wrong merges\n";
  }
}

}  // namespace

void print_summary(std::ostream& out, const std::string& directory, const json& evaluation) {
  out << std::setprecision(4);
  if (evaluation.contains("map")) print_map(out, evaluation["map"]);
  print_fleet(out, evaluation);
  if (evaluation.contains("modes")) print_modes(out, evaluation["modes"]);
  for (const auto& [id, agent] : evaluation["agents"].items()) {
    if (!agent.contains("ate_rmse")) continue;
    out << id << ": ATE " << agent["ate_rmse"].get<double>() << " m, aligned "
        << agent["ate_rmse_aligned"].get<double>() << " m, over " << agent["path_length"].get<double>()
        << " m\n";
  }
  for (const auto& pair : evaluation["pairs"]) {
    out << pair["a"].get<std::string>() << " - " << pair["b"].get<std::string>() << ": relative position "
        << pair["translation_rmse"].get<double>() << " m\n";
  }
  for (const auto& note : evaluation["notes"]) out << "note: " << note.get<std::string>() << '\n';
  out << "evaluation: " << directory << "/evaluation.html\n";
}

bool measured_anything(const json& evaluation) {
  if (evaluation.contains("map") || evaluation.contains("fleet") || !evaluation["pairs"].empty()) return true;
  for (const json& agent : evaluation["agents"]) {
    if (!agent.empty()) return true;
  }
  return false;
}

}  // namespace fleetmap::run_evaluation
