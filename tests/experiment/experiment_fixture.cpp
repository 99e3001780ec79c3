#include "experiment/experiment_fixture.hpp"

#include <cmath>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "fleetmap/config/experiment_file.hpp"

namespace fleetmap::experiment {

Engine FakeTwin::engine() {
  return [this](const Case& one, const std::filesystem::path& directory) { return run(one, directory); };
}

std::multiset<std::string> FakeTwin::ran() const {
  const std::scoped_lock lock(mutex_);
  return ran_;
}

Result<CaseResult> FakeTwin::run(const Case& one, const std::filesystem::path& directory) {
  {
    const std::scoped_lock lock(mutex_);
    ran_.insert(one.name);
  }
  if (one.name == stop_at) {
    *stop = true;
    return failure("ended by a signal");
  }
  if (failing.contains(one.name)) return failure("robot r1 is inside a panel\nmove it");
  if (throwing.contains(one.name)) throw std::runtime_error("out of memory");
  std::ofstream(directory / "map_error.png", std::ios::binary) << "picture of " << one.name;
  std::ofstream(directory / "store.db", std::ios::binary) << "large";
  const double n = static_cast<double>(one.agents), scatter = 1.0 + 0.01 * static_cast<double>(one.seed);
  CaseResult result;
  result.metrics["map.rmse"] = 0.2 / std::sqrt(n) * scatter;
  result.metrics["time"] = 600.0 / std::sqrt(n) * scatter;
  result.histograms["map.density"] = {2.0, {0.25, 0.5, 0.25}};
  result.pictures["error"] = "map_error.png";
  return result;
}

ExperimentTest::ExperimentTest() {
  folder_.write("fleet.yaml",
                "world: {file: farm.yaml}\nagents:\n  - {id: r1}\n  - {id: r2}\n  - {id: r3}\n");
  folder_.write("farm.yaml", "size: 60\n");
  write_experiment(
      "seed_keys: [world.seed]\n"
      "metrics:\n"
      "  - {name: map.rmse, title: RMSE, unit: m}\n"
      "  - {name: time, unit: s}\n"
      "studies:\n"
      "  - name: size\n"
      "    seeds: 2\n"
      "    axes: [{name: agents, values: [1, 2, 3]}]\n"
      "    metrics: [map.rmse, time]\n"
      "    histograms: [map.density]\n"
      "    pictures: [error]\n"
      "    expect:\n"
      "      - {metric: map.rmse, over: agents, shape: falls}\n"
      "      - {metric: time, over: agents, shape: falls_less_than_linearly}\n");
}

Result<config::ExperimentConfig> ExperimentTest::load(bool quick) const {
  return config::load_experiment(folder_.path() / "experiment.yaml", quick);
}

ExperimentResult ExperimentTest::run(const RunnerConfig& runner) {
  const auto config = load();
  if (!config) {
    ADD_FAILURE() << config.error().message;
    return {};
  }
  log_.str("");
  auto result = run_experiment(*config, twin_.engine(), runner, stop_, log_, false);
  if (!result) {
    ADD_FAILURE() << result.error().message;
    return {};
  }
  return *result;
}

}  // namespace fleetmap::experiment
