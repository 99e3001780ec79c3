#include "sensor_examination.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <memory>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "devices/live_devices.hpp"
#include "fleetmap/agent/sensor_mounts.hpp"
#include "fleetmap/config/robot_file.hpp"
#include "machine_check.hpp"
#include "options.hpp"
#include "robot/live_bus.hpp"
#include "sensor_listener.hpp"

namespace fleetmap::apps {
namespace {

constexpr Duration kLastScan = std::chrono::seconds(2);

CommandResult<config::RobotConfig> examined_robot(const DoctorOptions& options) {
  const auto overrides = parse_overrides(options.set);
  if (!overrides) return exit_with(kUsage, overrides.error());
  auto robot = config::load_robot(options.config, *overrides);
  if (!robot) return exit_with(kBadConfiguration, robot.error());
  robot->agent.perception.frame_patience = agent::kFramePatience;
  return std::move(*robot);
}

/// The robot's onboard link alone, under a name that no robot has.
bus::DdsBusConfig listener_dds(const config::RobotConfig& robot) {
  bus::DdsBusConfig dds = robot.dds;
  dds.long_range.enabled = dds.short_range.enabled = false;
  // Fast DDS shares memory among programs of one user, and the drivers are hardly ever root's.
  if (::geteuid() == 0) dds.onboard.shared_memory = false;
  dds.agent = free_name("doctor", robot.agent.exchange.fleet);
  return dds;
}

/// gpsd serves the agent and this program: fixes that it sends here stay away from the agent's topic, where
/// each would come twice.
agent::PerceptionConfig with_own_fixes(agent::PerceptionConfig config) {
  if (config.devices.gpsd) config.topics.fix = "rt/fleetmap/doctor/fix";
  return config;
}

/// Troubles of the devices that this program reads itself, and why no fix is heard of a GPS among them.
std::vector<std::string> device_findings(const std::vector<std::unique_ptr<DeviceInput>>& devices,
                                         const agent::DeviceConfig& config, std::size_t fixes) {
  std::vector<std::string> findings;
  const bool expected = config.nmea || config.gpsd || (config.mavlink && config.mavlink_gps);
  const std::string consequence = expected && fixes == 0 ? "no fix is heard: " : "";
  for (const auto& device : devices) {
    if (const std::string trouble = device->trouble(); !trouble.empty())
      findings.push_back(consequence + trouble);
  }
  if (config.gpsd && fixes == 0 && findings.empty()) {
    findings.push_back(fmt::format(
        "no fix is heard: gpsd at {} sends no position (TPV with a time). Connect a receiver to it (gpsd -n "
        "DEVICE; cgps shows what it receives), under open sky",
        agent::to_string(*config.gpsd)));
  }
  return findings;
}

/// Publishes what the robot's devices send, which the listener receives, until the time is up or a signal
/// comes. Returns what is wrong with them.
std::vector<std::string> listen_for(const agent::PerceptionConfig& config, bus::DdsBus& bus,
                                    const SensorListener& listener, double seconds, std::ostream& out) {
  // Its agent receives there if it runs, and publishes the scans.
  const auto lidar = publish_lidar(config, bus);
  if (!lidar) spdlog::info("{}", lidar.error().message);
  const auto devices = publish_devices(config, bus);
  if (!devices) return {devices.error().message};
  out << "listening for " << seconds
      << " s; drive 10 m and a turn to either side, so that units and motions show\n";
  bus.run_until([] { return stop_on_signals().load(); }, from_seconds(seconds));
  bus.run_until([&] { return listener.idle(); }, kLastScan);
  return device_findings(*devices, config.devices, listener.streams().fixes());
}

/// `of_devices` are device_findings(), of which one on fixes explains their silence better.
std::vector<std::string> unexplained_silences(const SensorListener& listener,
                                              const agent::SensorTopics& topics,
                                              const std::vector<std::string>& of_devices) {
  std::vector<std::string> silent = listener.silent_topics();
  const auto is_of_fixes = [](const std::string& finding) { return finding.starts_with("no fix is heard"); };
  if (std::ranges::any_of(of_devices, is_of_fixes))
    std::erase_if(
        silent, [&](const std::string& one) { return one.starts_with("no sample on " + topics.fix + ":"); });
  return silent;
}

std::vector<std::string> all_findings(SensorListener& listener, const config::RobotConfig& robot,
                                      const agent::PerceptionConfig& heard,
                                      const std::vector<std::string>& of_devices) {
  std::vector<std::string> findings = unexplained_silences(listener, heard.topics, of_devices);
  std::ranges::move(listener.findings(), std::back_inserter(findings));
  std::ranges::copy(of_devices, std::back_inserter(findings));
  std::ranges::move(machine_findings(machine_state(robot.agent.directory)), std::back_inserter(findings));
  if (listener.streams().scans() == 0) {
    const agent::SensorTopics& topics = robot.agent.perception.topics;
    findings.insert(findings.begin(),
                    "no scan on " + topics.points +
                        ": is the driver on, with ROS_DOMAIN_ID=" + std::to_string(robot.dds.onboard.domain) +
                        " (dds.onboard.domain), and does it publish " +
                        std::string(ros_codec::ros_name(topics.points_type)) + " (topics.points_type)?");
  }
  return findings;
}

}  // namespace

CommandResult<ExitCode> examine_sensors(const DoctorOptions& options, std::ostream& out) {
  const auto robot = examined_robot(options);
  if (!robot) return tl::unexpected(robot.error());
  auto bus = join_dds(listener_dds(*robot));
  if (!bus) return exit_with(kBadConfiguration, bus.error());
  const agent::PerceptionConfig perception = with_own_fixes(robot->agent.perception);
  SensorListener listener(perception, **bus);
  const auto of_devices = listen_for(perception, **bus, listener, options.seconds, out);
  listener.streams().print(out);
  for (const std::string& mount : listener.mounts()) out << mount << '\n';
  const std::vector<std::string> findings = all_findings(listener, *robot, perception, of_devices);
  for (const std::string& note : listener.notes()) out << note << '\n';
  for (const std::string& finding : findings) out << "- " << finding << '\n';
  if (findings.empty()) out << "nothing found\n";
  return findings.empty() ? kDone : kFailed;
}

}  // namespace fleetmap::apps
