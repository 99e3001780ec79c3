#include "twin_process.hpp"

#include <spdlog/spdlog.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <ostream>
#include <thread>
#include <vector>

#include "fleetmap/config/fleet_file.hpp"
#include "fleetmap/sim/scene.hpp"
#include "options.hpp"
#include "robot/live_robot.hpp"
#include "twin_results.hpp"
#include "twin_setup.hpp"

namespace fleetmap::apps {
namespace {

using Robots = std::vector<std::unique_ptr<LiveRobot>>;

Result<config::FleetConfig> load_twin(const std::string& file,
                                      const std::vector<config::Override>& overrides) {
  auto config = config::load_fleet(file, overrides);
  if (config && !config->twin) return failure(file + ": has no twin; expected world: {file: WORLD.yaml}");
  return config;
}

Status begin_results(const std::string& out, const TwinSetup& setup) {
  if (out.empty()) return {};
  const Status writable = make_writable(out);
  return writable ? write_site(out, setup) : writable;
}

CommandResult<Robots> make_robots(const config::FleetConfig& config, const TwinSetup& setup) {
  const auto scene = sim::Scene::create(setup.world->mesh());
  if (!scene) return exit_with(kFailed, scene.error());
  Robots robots;
  for (const auto& member : config.members) {
    auto robot = LiveRobot::create(member, setup, *scene);
    if (!robot) return exit_with(kBadConfiguration, robot.error());
    robots.push_back(std::move(*robot));
  }
  return robots;
}

/// Until a signal or for `duration` s.
void run_for(const Robots& robots, double duration) {
  for (const auto& robot : robots) robot->start();
  spdlog::info("twin of {} robots runs in real time; stop with Ctrl-C", robots.size());
  const std::atomic<bool>& stop = stop_on_signals();
  const auto begin = std::chrono::steady_clock::now();
  while (!stop) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
    if (duration > 0.0 && elapsed.count() > duration) break;
  }
  for (const auto& robot : robots) robot->stop();
}

Status write_trajectories_of_robots(const Robots& robots, const std::filesystem::path& out,
                                    const sim::World& world) {
  for (const auto& robot : robots) {
    if (const Status written = write_truth(out / robot->name(), robot->truth()); !written) return written;
  }
  return write_truth_cloud(out, world);
}

}  // namespace

CommandResult<ExitCode> run_twin(const TwinOptions& options, std::ostream& out) {
  const auto overrides = parse_overrides(options.set);
  if (!overrides) return exit_with(kUsage, overrides.error());
  auto config = load_twin(options.config, *overrides);
  if (!config) return exit_with(kBadConfiguration, config.error());
  const auto setup = set_up_twin(*config);
  if (!setup) return exit_with(kBadConfiguration, setup.error());
  if (const Status begun = begin_results(options.out, *setup); !begun)
    return exit_with(kFailed, begun.error());
  const auto robots = make_robots(*config, *setup);
  if (!robots) return tl::unexpected(robots.error());
  run_for(*robots, options.duration);
  for (const auto& robot : *robots) out << robot->name() << " drove " << robot->odometer() << " m\n";
  if (options.out.empty()) return kDone;
  const Status written = write_trajectories_of_robots(*robots, options.out, *setup->world);
  return written ? CommandResult<ExitCode>(kDone) : exit_with(kFailed, written.error());
}

}  // namespace fleetmap::apps
