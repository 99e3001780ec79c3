#include "sensor_examination.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <iterator>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "fleetmap/agent/sensor_mounts.hpp"
#include "fleetmap/config/robot_file.hpp"
#include "live_bus.hpp"
#include "live_devices.hpp"
#include "machine_check.hpp"
#include "options.hpp"
#include "sensor_listener.hpp"

namespace fleetmap::apps {
namespace {

CommandResult<config::RobotConfig> robot_of(const DoctorOptions& options) {
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
  dds.agent = free_name("doctor", robot.agent.exchange.fleet);
  return dds;
}

/// Publishes what the robot's devices send, which the listener receives, until the time is up or a signal
/// comes.
void listen(const agent::PerceptionConfig& config, bus::DdsBus& bus, double seconds, std::ostream& out) {
  // Its agent receives there if it runs, and publishes the scans.
  const auto lidar = publish_lidar(config, bus);
  if (!lidar) spdlog::info("{}", lidar.error().message);
  // gpsd would serve the agent and this program, so that each fix came twice.
  agent::PerceptionConfig perception = config;
  if (perception.devices.gpsd) spdlog::info("gps.gpsd: heard where the agent runs");
  perception.devices.gpsd.reset();
  const auto devices = publish_devices(perception, bus);
  out << "listening for " << seconds << " s; drive a turn, so that units of turn rates show\n";
  bus.run_until([] { return stop_on_signals().load(); }, from_seconds(seconds));
}

std::vector<std::string> all_findings(SensorListener& listener, const config::RobotConfig& robot) {
  std::vector<std::string> findings = listener.findings();
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
  const auto robot = robot_of(options);
  if (!robot) return tl::unexpected(robot.error());
  auto bus = join_dds(listener_dds(*robot));
  if (!bus) return exit_with(kBadConfiguration, bus.error());
  SensorListener listener(robot->agent.perception, **bus);
  listen(robot->agent.perception, **bus, options.seconds, out);
  listener.streams().print(out);
  for (const std::string& mount : listener.mounts()) out << mount << '\n';
  const std::vector<std::string> findings = all_findings(listener, *robot);
  for (const std::string& finding : findings) out << "- " << finding << '\n';
  if (findings.empty()) out << "nothing found\n";
  return findings.empty() ? kDone : kFailed;
}

}  // namespace fleetmap::apps
