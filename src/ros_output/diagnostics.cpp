#include "fleetmap/ros_output/diagnostics.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

namespace fleetmap::ros_output {
namespace {

using ros_codec::DiagnosticsMsg;
using Item = DiagnosticsMsg::Item;
using Level = DiagnosticsMsg::Level;

/// A sensor is stale beyond; GPS may send every other second.
constexpr double kSilent = 5.0;  // s

Item health(const RobotState& state) {
  Item item{Level::ok, "fleetmap: sensor health", "no finding", state.self.str(), {}};
  for (std::size_t k = 0; k < state.notes.size(); ++k)
    item.values.emplace_back(fmt::format("note {}", k + 1), state.notes[k]);
  if (state.findings.empty()) return item;
  item.level = Level::warning;
  item.message = state.findings.back();
  for (std::size_t k = 0; k < state.findings.size(); ++k)
    item.values.emplace_back(fmt::format("finding {}", k + 1), state.findings[k]);
  return item;
}

Item sensor(const monitor::SensorNow& sensor, const AgentId& self) {
  const bool silent = sensor.silent_s > kSilent;
  Item item{silent ? Level::stale : Level::ok,
            "fleetmap: " + sensor.name,
            sensor.per_second > 0.0 ? fmt::format("{:.1f} Hz", sensor.per_second)
                                    : fmt::format("last sample {:.0f} s ago", sensor.silent_s),
            self.str(),
            {}};
  item.values.emplace_back("samples", std::to_string(sensor.samples));
  if (sensor.clock_behind_s)
    item.values.emplace_back("clock behind, s", fmt::format("{:.3f}", *sensor.clock_behind_s));
  if (sensor.clock_slow_ppm)
    item.values.emplace_back("clock slow, ppm", fmt::format("{:.1f}", *sensor.clock_slow_ppm));
  return item;
}

bool lost(const monitor::RobotNow& robot, const RobotState& state) {
  if (robot.id == state.self || !state.lost_after_s) return false;
  return std::ranges::none_of(
      robot.heard, [&](const monitor::LastHeard& heard) { return heard.seconds_ago <= *state.lost_after_s; });
}

Item robot(const monitor::RobotNow& robot, const RobotState& state) {
  Item item{Level::ok, "fleetmap: robot " + robot.id.str(), robot.activity, robot.id.str(), {}};
  if (lost(robot, state)) {
    item.level = Level::stale;
    if (!robot.heard.empty()) item.message = "is lost: it is not heard any more";
    item.values.emplace_back("activity", robot.activity);
  } else if (!robot.problems.empty()) {
    item.level = Level::warning;
    item.message = robot.problems.front();
    item.values.emplace_back("activity", robot.activity);
  }
  for (std::size_t k = 0; k < robot.problems.size(); ++k)
    item.values.emplace_back(fmt::format("problem {}", k + 1), robot.problems[k]);
  for (const monitor::LastHeard& heard : robot.heard)
    item.values.emplace_back("heard on " + heard.link, fmt::format("{:.1f} s ago", heard.seconds_ago));
  if (robot.battery) item.values.emplace_back("battery, %", fmt::format("{:.0f}", 100.0 * *robot.battery));
  if (robot.sigma_m) item.values.emplace_back("position sigma, m", fmt::format("{:.2f}", *robot.sigma_m));
  item.values.emplace_back("nodes", std::to_string(robot.nodes));
  item.values.emplace_back("alignments", std::to_string(robot.alignments));
  item.values.emplace_back("submaps", std::to_string(robot.submaps));
  return item;
}

}  // namespace

DiagnosticsMsg diagnostics(const RobotState& state) {
  DiagnosticsMsg message{state.stamp, {health(state)}};
  for (const monitor::SensorNow& one : state.sensors)
    if (one.samples > 0) message.items.push_back(sensor(one, state.self));
  for (const monitor::RobotNow& one : state.robots) message.items.push_back(robot(one, state));
  return message;
}

}  // namespace fleetmap::ros_output
