#include "recording_replay.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <ostream>
#include <string>

#include "fleetmap/bus/dds_bus.hpp"
#include "fleetmap/recording/reader.hpp"
#include "fleetmap/recording/survey.hpp"
#include "health/sensor_settings.hpp"
#include "options.hpp"
#include "recording_player.hpp"
#include "robot/live_bus.hpp"
#include "sample_player.hpp"

namespace fleetmap::apps {
namespace {

constexpr Duration kLinger = std::chrono::seconds(1);

Result<config::RobotConfig> replayed_robot(const ReplayOptions& options) {
  auto robot = sensor_settings(options.config, options.set);
  if (!robot) return tl::unexpected(robot.error().error);
  if (!options.as.empty()) {
    const auto id = AgentId::parse(options.as);
    if (!id) return failure("--as: " + id.error().message);
    robot->agent.id = *id;
  }
  robot->dds.agent = robot->agent.id;
  // A replay stands in for the sensors: it has no business on the radios.
  robot->dds.long_range.enabled = false;
  robot->dds.short_range.enabled = false;
  return std::move(*robot);
}

/// Until each topic of a sensor has a reader, or a signal.
Status wait_for_agent(bus::DdsBus& bus, const config::RobotConfig& robot, double patience,
                      const std::atomic<bool>& stop) {
  const auto matched = [&] {
    return stop ||
           std::ranges::all_of(sensor_topics(robot.agent.perception.topics),
                               [&](const bus::Topic& topic) { return bus.matches(topic).readers > 0; });
  };
  const bus::Handle wake = bus.every(std::chrono::milliseconds(50), [] {});
  if (bus.run_until(matched, from_seconds(patience))) return {};
  return failure("fleetmap replay: no agent listens on onboard domain " +
                 std::to_string(robot.dds.onboard.domain) + " after " + std::to_string(patience) +
                 " s; start the agent first, with the same dds.onboard.domain");
}

/// Plays to the end, or until a signal.
Status play(bus::DdsBus& bus, RecordingPlayer& player, const std::filesystem::path& recording,
            const std::atomic<bool>& stop) {
  if (const Status started = player.start(); !started)
    return failure(recording.string() + ": " + started.error().message);
  bus.run_until([&] { return stop || player.done(); }, Duration::max());
  // The last samples leave from a thread of Fast DDS; a participant that goes at once would take them along.
  bus.run_until([&] { return stop.load(); }, kLinger);
  return player.error().empty() ? Status() : failure(player.error());
}

}  // namespace

CommandResult<Replay> replay_of(const ReplayOptions& options) {
  auto robot = replayed_robot(options);
  if (!robot) return exit_with(kBadConfiguration, robot.error());
  Replay replay{std::move(*robot), options.recording, {}};
  replay.reader.ouster_metadata = replay.robot.agent.perception.ouster.metadata;
  if (replay.robot.recording) {
    replay.reader = replay.robot.recording->reader;
    if (replay.recording.empty()) replay.recording = replay.robot.recording->path;
  }
  if (replay.recording.empty())
    return exit_with(kUsage, {"fleetmap replay: name a recording, or give -c a file with recording.path"});
  return replay;
}

CommandResult<ExitCode> replay_recording(const ReplayOptions& options, std::ostream& out) {
  const auto replay = replay_of(options);
  if (!replay) return tl::unexpected(replay.error());
  auto reader = recording::open(replay->recording, replay->reader);
  if (!reader) return exit_with(kFailed, reader.error());
  auto bus = join_dds(replay->robot.dds);
  if (!bus) return exit_with(kBadConfiguration, bus.error());
  const std::atomic<bool>& stop = stop_on_signals();
  const auto survey = recording::survey(replay->recording, replay->reader);
  if (!survey) return exit_with(kFailed, survey.error());
  RecordingPlayer player(**reader, *survey, **bus, replay->robot.agent.perception.topics, options.rate);
  if (const Status heard = wait_for_agent(**bus, replay->robot, options.wait_for_reader, stop); !heard)
    return exit_with(kFailed, heard.error());
  if (const Status played = play(**bus, player, replay->recording, stop); !played)
    return exit_with(kFailed, played.error());
  out << "played " << player.played() << " samples of " << replay->recording.string() << '\n';
  for (const auto& [name, count] : (*reader)->counters().named()) {
    if (count > 0) out << "  " << name << ": " << count << '\n';
  }
  return kDone;
}

}  // namespace fleetmap::apps
