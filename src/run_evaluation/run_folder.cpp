#include "run_folder.hpp"

#include <algorithm>
#include <fstream>

#include "fleetmap/cloud/file_io.hpp"
#include "fleetmap/config/world_file.hpp"
#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/file_hash.hpp"
#include "fleetmap/core/paths.hpp"
#include "fleetmap/output/map_recipe.hpp"
#include "fleetmap/output/placed_store.hpp"
#include "fleetmap/output/trajectory_file.hpp"
#include "fleetmap/sim/ground_truth.hpp"
#include "fleetmap/sim/mesh.hpp"
#include "fleetmap/sim/mesh_file.hpp"
#include "fleetmap/sim/world.hpp"

namespace fleetmap::run_evaluation {
namespace {

namespace fs = std::filesystem;

std::optional<output::Trajectory> trajectory_in(const fs::path& file, std::vector<std::string>& notes) {
  if (!is_there(file)) return std::nullopt;
  auto read = output::read_tum(file);
  if (!read) {
    notes.push_back(read.error().message);
    return std::nullopt;
  }
  if (read->empty()) {
    notes.push_back(file.string() + ": holds no pose");
    return std::nullopt;
  }
  return std::move(*read);
}

fs::path truth_file(const fs::path& truths, const AgentFolder& agent) {
  if (truths.empty()) return agent.directory / "truth.tum";
  const fs::path flat = truths / (agent.id.str() + ".tum");
  return is_there(flat) ? flat : truths / agent.id.str() / "truth.tum";
}

nlohmann::json report_in(const fs::path& file, std::vector<std::string>& notes) {
  std::ifstream in(file);
  if (!in) return nullptr;
  auto report = nlohmann::json::parse(in, nullptr, false);
  if (report.is_object()) return report;
  notes.push_back(file.string() + ": is not the JSON of a run's report; left alone");
  return nullptr;
}

/// Maps and the report are what a run writes at its end.
void note_cut_off(RunFolder& run) {
  if (is_there(run.directory / "report.json")) return;
  for (AgentFolder& agent : run.agents) {
    const fs::path store = agent.directory / "store.db";
    agent.cut_off = is_there(store) && !is_there(agent.directory / "map.ply") &&
                    !is_there(agent.directory / "report.json");
    if (!agent.cut_off) continue;
    run.notes.push_back(agent.directory.string() +
                        ": the run was cut off, or still goes on: no map was written; `fleetmap map export " +
                        store.string() + " --out map.ply` saves what the store holds");
  }
}

}  // namespace

Result<RunFolder> open_run(const fs::path& directory, const fs::path& truths) {
  if (!truths.empty() && !is_there(truths))
    return failure(truths.string() + ": no such folder of true trajectories");
  RunFolder run;
  run.directory = directory;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(directory, error)) {
    const auto id = AgentId::parse(entry.path().filename().string());
    if (!id || !entry.is_directory(error)) continue;
    const fs::path& path = entry.path();
    if (!is_there(path / "trajectory.tum") && !is_there(path / "map.ply") && !is_there(path / "odometry.tum"))
      continue;
    AgentFolder agent;
    agent.id = *id;
    agent.directory = path;
    run.agents.push_back(std::move(agent));
  }
  if (error) return failure(directory.string() + ": cannot be read: " + error.message());
  if (run.agents.empty()) {
    return failure(
        directory.string() +
        ": holds no robot's folder with trajectory.tum or map.ply; give the --out of fleetmap run");
  }
  std::ranges::sort(run.agents, {}, &AgentFolder::id);
  for (AgentFolder& agent : run.agents) {
    agent.trajectory = trajectory_in(agent.directory / "trajectory.tum", run.notes);
    agent.ekf = trajectory_in(agent.directory / "ekf.tum", run.notes);
    agent.odometry = trajectory_in(agent.directory / "odometry.tum", run.notes);
    agent.truth = trajectory_in(truth_file(truths, agent), run.notes);
    const fs::path registrations = agent.directory / output::kRegistrationsFile;
    agent.registrations = output::read_registrations(registrations);
    if (auto note = output::damage_note(agent.registrations.damaged, registrations))
      run.notes.push_back(std::move(*note));
    if (!truths.empty() && !agent.truth)
      run.notes.push_back(truths.string() + ": holds no usable true trajectory of " + agent.id.str());
  }
  run.report = report_in(directory / "report.json", run.notes);
  note_cut_off(run);
  return run;
}

std::vector<DistinctMap> distinct_maps(RunFolder& run) {
  std::vector<DistinctMap> maps;
  for (const AgentFolder& agent : run.agents) {
    const fs::path file = agent.directory / "map.ply";
    if (!is_there(file)) {
      if (agent.cut_off) continue;
      run.notes.push_back(file.string() + ": is missing: " + agent.id.str() + " has no map");
      continue;
    }
    const auto hashed = file_hash(file);
    if (!hashed) {
      run.notes.push_back(hashed.error().message);
      continue;
    }
    const std::string hash = to_hex(*hashed);
    const auto same = std::ranges::find(maps, hash, &DistinctMap::hash);
    if (same != maps.end()) {
      same->agents.push_back(agent.id);
    } else {
      maps.push_back({{agent.id}, file, hash});
    }
  }
  std::ranges::stable_sort(maps, std::greater{}, [](const DistinctMap& map) { return map.agents.size(); });
  return maps;
}

}  // namespace fleetmap::run_evaluation
