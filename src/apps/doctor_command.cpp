// `fleetmap doctor`: listens to a robot's sensors as its agent would, beside it or before it runs.
#include <spdlog/spdlog.h>

#include <algorithm>
#include <iostream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "commands.hpp"
#include "fleetmap/agent/sensor_mounts.hpp"
#include "fleetmap/config/robot_file.hpp"
#include "live_bus.hpp"
#include "live_devices.hpp"
#include "machine_check.hpp"
#include "options.hpp"
#include "sensor_listener.hpp"

namespace fleetmap::apps {
namespace {

struct DoctorOptions {
  std::string config;
  double seconds = 30.0;
  std::vector<std::string> set;
};

int examine(const DoctorOptions& options) {
  const auto overrides = parse_overrides(options.set);
  if (!overrides) return report(overrides.error(), kUsage);
  auto robot = config::load_robot(options.config, *overrides);
  if (!robot) return report(robot.error(), kBadConfiguration);
  bus::DdsBusConfig dds = robot->dds;
  dds.long_range.enabled = dds.short_range.enabled = false;
  dds.agent = free_name("doctor", robot->agent.exchange.fleet);
  auto bus = join_dds(dds);
  if (!bus) return report(bus.error(), kBadConfiguration);
  robot->agent.perception.frame_patience = agent::kFramePatience;
  SensorListener listener(robot->agent.perception, **bus);
  // Its agent receives there if it runs, and publishes the scans.
  const auto lidar = publish_velodyne(robot->agent.perception, **bus);
  if (!lidar) spdlog::info("{}", lidar.error().message);
  // gpsd would serve the agent and this program, so that each fix came twice.
  agent::PerceptionConfig perception = robot->agent.perception;
  if (perception.devices.gpsd) spdlog::info("gps.gpsd: heard where the agent runs");
  perception.devices.gpsd.reset();
  const auto devices = publish_devices(perception, **bus);
  std::cout << "listening for " << options.seconds << " s; drive a turn, so that units of turn rates show\n";
  (*bus)->run_until([] { return stop_on_signals().load(); }, from_seconds(options.seconds));
  listener.streams().print(std::cout);
  for (const std::string& mount : listener.mounts()) std::cout << mount << '\n';
  std::vector<std::string> findings = listener.findings();
  std::ranges::move(machine_findings(machine_state(robot->agent.directory)), std::back_inserter(findings));
  if (listener.streams().scans() == 0) {
    findings.insert(findings.begin(), "no scan on " + robot->agent.perception.topics.points +
                                          ": is the driver on, with ROS_DOMAIN_ID=" +
                                          std::to_string(dds.onboard.domain) + " (dds.onboard.domain)?");
  }
  for (const std::string& finding : findings) std::cout << "- " << finding << '\n';
  if (findings.empty()) std::cout << "nothing found\n";
  return findings.empty() ? kDone : kFailed;
}

}  // namespace

void add_doctor(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<DoctorOptions>();
  CLI::App* command = app.add_subcommand("doctor",
                                         "listens to a robot's sensors and says what is wrong with their "
                                         "clocks, units, rates and mounts; exit code "
                                         "1 if anything is");
  command->add_option("-c,--config", options->config, "AGENT.yaml")->required();
  command->add_option("--seconds", options->seconds, "how long to listen")->check(CLI::PositiveNumber);
  command->add_option("--set", options->set, "key=value")->allow_extra_args(false);
  command->callback([options, &exit_code] { exit_code = examine(*options); });
}

}  // namespace fleetmap::apps
