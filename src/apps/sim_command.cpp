#include <spdlog/spdlog.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "commands.hpp"
#include "fleetmap/config/fleet_file.hpp"
#include "fleetmap/fleet_codec/messages.hpp"
#include "fleetmap/fleet_codec/topics.hpp"
#include "fleetmap/output/trajectory_file.hpp"
#include "fleetmap/ros_codec/point_cloud2.hpp"
#include "fleetmap/ros_codec/samples.hpp"
#include "fleetmap/ros_codec/topics.hpp"
#include "fleetmap/sim/robot_twin.hpp"
#include "fleetmap/sim/scene.hpp"
#include "live_bus.hpp"
#include "live_robot.hpp"
#include "options.hpp"
#include "twin_results.hpp"
#include "twin_setup.hpp"

namespace fleetmap::apps {
namespace {

struct SimOptions {
  std::string config;
  std::string out;
  double duration = 0.0;
  std::vector<std::string> set;
};

int run(const SimOptions& options) {
  const auto overrides = parse_overrides(options.set);
  if (!overrides) return report(overrides.error(), kUsage);
  auto config = config::load_fleet(options.config, *overrides);
  if (!config) return report(config.error(), kBadConfiguration);
  if (!config->twin)
    return report({options.config + ": has no twin; expected world: {file: WORLD.yaml}"}, kBadConfiguration);
  const auto setup = set_up_twin(*config);
  if (!setup) return report(setup.error(), kBadConfiguration);
  if (!options.out.empty()) {
    if (const Status writable = make_writable(options.out); !writable)
      return report(writable.error(), kFailed);
    if (const Status drawn = write_site(options.out, *setup); !drawn) return report(drawn.error(), kFailed);
  }
  auto scene = sim::Scene::create(setup->world->mesh());
  if (!scene) return report(scene.error(), kFailed);
  std::vector<std::unique_ptr<LiveRobot>> robots;
  for (const auto& member : config->members) {
    auto robot = LiveRobot::create(member, *setup, *scene);
    if (!robot) return report(robot.error(), kBadConfiguration);
    robots.push_back(std::move(*robot));
  }
  for (const auto& robot : robots) robot->start();
  spdlog::info("twin of {} robots runs in real time; stop with Ctrl-C", robots.size());

  const std::atomic<bool>& stop = stop_on_signals();
  const auto begin = std::chrono::steady_clock::now();
  while (!stop) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
    if (options.duration > 0.0 && elapsed.count() > options.duration) break;
  }
  for (const auto& robot : robots) robot->stop();
  for (const auto& robot : robots) {
    std::cout << robot->name() << " drove " << robot->odometer() << " m\n";
    if (options.out.empty()) continue;
    if (const Status written =
            write_truth(std::filesystem::path(options.out) / robot->name(), robot->truth());
        !written)
      return report(written.error(), kFailed);
  }
  if (!options.out.empty()) {
    if (const Status written = write_truth_cloud(options.out, *setup->world); !written)
      return report(written.error(), kFailed);
  }
  return kDone;
}

}  // namespace

void add_sim(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<SimOptions>();
  CLI::App* command =
      app.add_subcommand("sim", "the digital twin over DDS, in real time, for agents in other processes");
  command->add_option("-c,--config", options->config, "FLEET.yaml with world: {file: WORLD.yaml}")
      ->required();
  command->add_option("--out", options->out, "leave the truth there: NAME/truth.tum and truth.ply")
      ->check(some_path());
  command->add_option("--duration", options->duration, "s; end by itself")->check(non_negative_number());
  command->add_option("--set", options->set, "key=value, overrides any configuration key")
      ->allow_extra_args(false);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace fleetmap::apps
