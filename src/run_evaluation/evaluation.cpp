#include "fleetmap/run_evaluation/evaluation.hpp"

#include <nlohmann/json.hpp>

#include "evaluation_page.hpp"
#include "fleet_evaluation.hpp"
#include "fleetmap/core/paths.hpp"
#include "fleetmap/core/whole_file.hpp"
#include "fleetmap/eval/trajectory.hpp"
#include "fleetmap/output/trajectory_file.hpp"
#include "map_evaluation.hpp"
#include "mode_evaluation.hpp"
#include "run_folder.hpp"
#include "stored_fleet.hpp"
#include "truth_cloud.hpp"

namespace fleetmap::run_evaluation {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

json errors_json(const eval::TrajectoryErrors& e) {
  return {{"poses", e.pairs},
          {"ate_rmse", e.ate_rmse},
          {"ate_rmse_aligned", e.ate_rmse_aligned},
          {"ate_max", e.ate_max},
          {"rpe_translation", e.rpe_translation},
          {"rpe_rotation", e.rpe_rotation},
          {"rpe_length", e.rpe_length},
          {"rpe_segments", e.rpe_segments},
          {"path_length", e.path_length}};
}

/// Errors of one track, or a note why there are none.
json compared(const std::optional<output::Trajectory>& estimate, const AgentFolder& agent, const char* name,
              std::vector<std::string>& notes) {
  if (!estimate || !agent.truth) return nullptr;
  const auto errors = eval::compare(*estimate, *agent.truth);
  if (errors) return errors_json(*errors);
  notes.push_back((agent.directory / name).string() + ": " + errors.error().message);
  return nullptr;
}

json agents_json(RunFolder& run) {
  json agents = json::object();
  for (const AgentFolder& agent : run.agents) {
    json one = compared(agent.trajectory, agent, "trajectory.tum", run.notes);
    if (one.is_null()) one = json::object();
    if (json ekf = compared(agent.ekf, agent, "ekf.tum", run.notes); !ekf.is_null()) one["ekf"] = ekf;
    if (json odometry = compared(agent.odometry, agent, "odometry.tum", run.notes); !odometry.is_null()) {
      // In a frame of its own: only what does not depend on where that lies.
      for (const char* key : {"ate_rmse", "ate_max"}) odometry.erase(key);
      one["odometry"] = odometry;
    }
    agents[agent.id.str()] = one;
  }
  return agents;
}

json pairs_json(const RunFolder& run) {
  json pairs = json::array();
  for (std::size_t i = 0; i < run.agents.size(); ++i) {
    for (std::size_t k = i + 1; k < run.agents.size(); ++k) {
      const AgentFolder &a = run.agents[i], &b = run.agents[k];
      if (!a.trajectory || !b.trajectory || !a.truth || !b.truth) continue;
      const auto error = eval::compare_pairwise(*a.trajectory, *b.trajectory, *a.truth, *b.truth);
      if (!error) continue;
      pairs.push_back({{"a", a.id.str()},
                       {"b", b.id.str()},
                       {"poses", error->pairs},
                       {"translation_rmse", error->translation_rmse},
                       {"rotation_rmse", error->rotation_rmse}});
    }
  }
  return pairs;
}

/// Bytes by link and robot, from the report's list of links.
json links_json(const json& report, double mapped_area) {
  if (!report.is_object() || !report.contains("links") || !report["links"].is_array()) return nullptr;
  json links = {{"long_range_bytes", 0}, {"short_range_bytes", 0}, {"per_agent", json::object()}};
  double all = 0.0;
  for (const json& row : report["links"]) {
    if (!row.is_object()) continue;
    const std::string link = row.value("link", "");
    if (link != "long_range" && link != "short_range") continue;
    const std::uint64_t bytes = row.value("wire_bytes", std::uint64_t{0});
    const std::string key = link + "_bytes";
    links[key] = links[key].get<std::uint64_t>() + bytes;
    json& agent = links["per_agent"][row.value("agent", "")];
    if (agent.is_null()) agent = json::object();
    agent[key] = agent.value(key, std::uint64_t{0}) + bytes;
    agent[link + "_airtime_s"] = agent.value(link + "_airtime_s", 0.0) + row.value("airtime_s", 0.0);
    all += static_cast<double>(bytes);
  }
  if (mapped_area > 0.0) {
    links["bytes_per_m2"] = all / mapped_area;
    links["long_range_bytes_per_m2"] = links["long_range_bytes"].get<double>() / mapped_area;
    links["short_range_bytes_per_m2"] = links["short_range_bytes"].get<double>() / mapped_area;
  }
  return links;
}

Result<std::optional<cloud::PointCloud>> truth_of(const fs::path& directory, const EvaluationInputs& inputs) {
  if (inputs.truth) return inputs.truth;
  fs::path file = inputs.truth_file;
  if (file.empty() && is_there(directory / "truth.ply")) file = directory / "truth.ply";
  if (file.empty()) return std::nullopt;
  auto truth = truth_cloud(file, inputs.points_per_m2);
  if (!truth) return tl::unexpected(truth.error());
  return std::optional(std::move(*truth));
}

double registration_seconds(const AgentFolder& agent) {
  double seconds = 0.0;
  for (const output::RegistrationRow& row : agent.registrations.rows) seconds += row.cpu_seconds;
  return seconds;
}

/// CPU of perception and registration, mean over the robots. The twin and the exchange are not included.
json cpu_json(const RunFolder& run) {
  const json agents = run.report.is_object() ? run.report.value("agents", json::object()) : json::object();
  double odometry = 0.0, registration = 0.0;
  std::size_t robots = 0;
  for (const AgentFolder& folder : run.agents) {
    const json sensors = agents.value(folder.id.str(), json::object()).value("sensors", json::object());
    if (!sensors.contains("scans")) continue;
    odometry += 1e-3 * sensors.value("scans", 0.0) *
                sensors.value("odometry_cpu_ms", json::object()).value("mean", 0.0);
    registration += registration_seconds(folder);
    ++robots;
  }
  if (robots == 0) return nullptr;
  const auto count = static_cast<double>(robots);
  json cpu = {{"odometry_s", odometry / count},
              {"registration_s", registration / count},
              {"per_robot_s", (odometry + registration) / count}};
  if (const double time = run.report.value("virtual_time_s", 0.0); time > 0.0)
    cpu["share"] = (odometry + registration) / count / time;
  return cpu;
}

/// The contents of a robot whose map more robots share than any other; none, with a note, if its store is
/// not readable.
std::optional<StoredFleet> fleet_of_largest_group(RunFolder& run, const std::vector<DistinctMap>& maps) {
  if (maps.empty()) return std::nullopt;
  auto held = open_stored(maps.front().file.parent_path() / "store.db");
  if (held) return std::move(*held);
  run.notes.push_back(held.error().message + "; alignments are not evaluated, robots not told apart");
  return std::nullopt;
}

void note_missing_truth(RunFolder& run, bool have_truth) {
  if (!have_truth) {
    run.notes.push_back(
        "no true surface (--truth, or truth.ply in the folder): the map is described, not "
        "compared");
  }
  for (const AgentFolder& agent : run.agents) {
    if (!agent.truth)
      run.notes.push_back("no true trajectory of " + agent.id.str() + ": its errors are not known");
  }
}

/// Writes pictures, evaluation.json, the evaluation into report.json where there is one, and with `page`
/// evaluation.html.
Status write_evaluation(const fs::path& directory, RunFolder& run, const json& evaluation,
                        const std::vector<MapPicture>& pictures, bool page) {
  for (const MapPicture& picture : pictures) {
    if (Status written = write_picture(directory, picture); !written) return written;
  }
  if (Status written = write_whole_file(directory / "evaluation.json", evaluation.dump(2) + '\n'); !written)
    return written;
  if (run.report.is_object()) {
    run.report["evaluation"] = evaluation;
    if (Status written = write_whole_file(directory / "report.json", run.report.dump(2) + '\n'); !written)
      return written;
  }
  if (!page) return {};
  return evaluation_page(run, evaluation, pictures).write(directory / "evaluation.html");
}

Result<json> evaluated(const fs::path& directory, const EvaluationInputs& inputs) {
  if (const Status valid = inputs.map.validate(); !valid) return tl::unexpected(valid.error());
  auto run = open_run(directory, inputs.truth_trajectories);
  if (!run) return tl::unexpected(run.error());
  auto truth = truth_of(directory, inputs);
  if (!truth) return tl::unexpected(truth.error());
  note_missing_truth(*run, truth->has_value());
  json evaluation = json::object();
  evaluation["agents"] = agents_json(*run);
  evaluation["pairs"] = pairs_json(*run);
  const std::vector<DistinctMap> distinct = distinct_maps(*run);
  std::optional<StoredFleet> held = fleet_of_largest_group(*run, distinct);
  const eval::TruePoses nodes = held ? true_poses(*run, held->store) : eval::TruePoses{};
  if (json fleet = fleet_json(*run, held ? &*held : nullptr, nodes); !fleet.is_null())
    evaluation["fleet"] = fleet;
  if (!nodes.empty()) {
    evaluation["alignments"] = alignments_json(*run, *held, nodes);
    evaluation["calibration"] = calibration_json(*run, *held, nodes);
  }
  MapEvaluation maps(inputs, std::move(*truth), nodes);
  if (const Status done = maps.add_to(evaluation, distinct, held ? &*held : nullptr); !done)
    return tl::unexpected(done.error());
  if (held && !maps.thinned()) {
    if (json modes = modes_json(*run, *held, nodes, maps, evaluation, inputs); !modes.is_null())
      evaluation["modes"] = std::move(modes);
  }
  if (json cpu = cpu_json(*run); !cpu.is_null()) evaluation["cpu"] = std::move(cpu);
  run->notes.insert(run->notes.end(), maps.notes.begin(), maps.notes.end());
  const double area = evaluation.contains("map") ? evaluation["map"].value("mapped_area", 0.0) : 0.0;
  if (json links = links_json(run->report, area); !links.is_null()) evaluation["links"] = links;
  evaluation["notes"] = run->notes;
  if (const Status written = write_evaluation(directory, *run, evaluation, maps.pictures, inputs.page);
      !written)
    return tl::unexpected(written.error());
  return evaluation;
}

}  // namespace

Result<json> evaluate_run(const fs::path& directory, const EvaluationInputs& inputs) {
  try {
    return evaluated(directory, inputs);
  } catch (const json::exception& error) {
    return failure((directory / "report.json").string() + ": is no report of a run (" + error.what() + ")");
  }
}

}  // namespace fleetmap::run_evaluation
