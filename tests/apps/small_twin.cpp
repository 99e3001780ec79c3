#include "small_twin.hpp"

#include <fstream>

#include "support/command_line.hpp"
#include "support/process.hpp"

namespace fleetmap::testing {

SmallTwin::SmallTwin() {
  folder_.write("world.yaml",
                "kind: solar_farm\nseed: 1\nsize: [32, 26]\nmargin: 8\nheadland: 6\nrow_pitch: 7\n"
                "table_length: 9\nroad_every: 0\ncabins: 1\ntrees: 6\nmissing_tables: 0\n"
                "terrain: {rolling_amplitude: 0.15, rolling_wavelength: 30}\nterrain_cell: 0.5\n");
  folder_.write("lidar.yaml",
                "name: few-rays\nmodel: vlp16\nrate: 5\ncolumns: 900\nmin_range: 0.5\nmax_range: 40\n"
                "elevations_deg: {first: -15, last: 15, rings: 16}\nrange_noise: 0.03\n");
  write_fleet("");
}

void SmallTwin::write_fleet(const std::string& top_keys, const std::vector<std::string>& agent_keys,
                            const std::string& mission_keys) const {
  std::string text =
      "world: {file: world.yaml}\nmax_time: 300\nsite: {origin: [39.0, -3.0, 600.0]}\n"
      "mission: {every: 1, rendezvous: true, speed: 1.5" +
      mission_keys + "}\n" + top_keys +
      "defaults:\n"
      "  lidar: {translation: [0, 0, 0.6], max_range: 40, min_range: 0.6}\n"
      "  imu: {translation: [0, 0, 0.1]}\n"
      "  gps: {translation: [-0.2, 0, 0.5]}\n"
      "  nodes: {spacing: 5}\n"
      "  robot: {lidar: lidar.yaml, gps: {white_sigma: 0.3, drift_sigma: 1.0, correlation_time: 60}}\n"
      "agents:\n";
  for (std::size_t k = 0; k < 3; ++k) {
    text += "  - id: r" + std::to_string(k + 1) + "\n";
    if (k < agent_keys.size() && !agent_keys[k].empty()) text += "    " + agent_keys[k] + "\n";
  }
  folder_.write("fleet.yaml", text);
}

SmallTwin::Run SmallTwin::run(const std::string& name, const std::vector<std::string>& more) const {
  std::vector<std::string> arguments{testing::kProgram,           "run",   "-c",
                                     path("fleet.yaml").string(), "--out", path(name).string()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  Process process(arguments);
  Run run;
  run.exit_code = process.wait();
  run.output = process.output();
  run.out = path(name);
  if (std::ifstream file(run.out / "report.json"); file)
    run.report = nlohmann::json::parse(file, nullptr, false);
  return run;
}

}  // namespace fleetmap::testing
