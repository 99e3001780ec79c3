#include "recording_replay.hpp"

#include <spdlog/fmt/fmt.h>

#include <array>
#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "fleetmap/bus/dds_bus.hpp"
#include "fleetmap/core/text_list.hpp"
#include "fleetmap/recording/reader.hpp"
#include "fleetmap/recording/survey.hpp"
#include "fleetmap/sensor/clock_offsets.hpp"
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

/// Readers of each of sensor_topics().
std::vector<std::size_t> readers_of(const bus::DdsBus& bus, const std::vector<bus::Topic>& topics) {
  std::vector<std::size_t> readers;
  for (const bus::Topic& topic : topics) readers.push_back(bus.matches(topic).readers);
  return readers;
}

/// Until each topic of a sensor that the robot uses has a reader, or a signal.
Status wait_for_agent(bus::DdsBus& bus, const config::RobotConfig& robot, double patience,
                      const std::atomic<bool>& stop) {
  const std::vector<bus::Topic> topics = sensor_topics(robot.agent.perception.topics);
  const auto matched = [&] { return stop || check_readers(robot, readers_of(bus, topics)); };
  const bus::Handle wake = bus.every(std::chrono::milliseconds(50), [] {});
  if (bus.run_until(matched, from_seconds(patience))) return {};
  const Status heard = check_readers(robot, readers_of(bus, topics));
  if (heard) return {};
  return failure("fleetmap replay: after " + fmt::format("{:.3g}", patience) + " s " + heard.error().message);
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

Status check_readers(const config::RobotConfig& robot, const std::vector<std::size_t>& readers) {
  constexpr std::array kKeys{"topics.points", "topics.imu", "topics.fix", "topics.wheel"};
  const std::vector<bus::Topic> topics = sensor_topics(robot.agent.perception.topics);
  std::string read, unread;
  for (std::size_t k = 0; k < topics.size(); ++k) {
    const bool used = k != static_cast<std::size_t>(sensor::Source::kGps) || robot.agent.perception.uses_gps;
    const std::string& name = topics[k].name;
    const std::string in_ros = name.starts_with("rt/") ? name.substr(2) : name;
    if (readers[k] > 0) {
      append_to_list(read, in_ros);
    } else if (used) {
      append_to_list(unread, in_ros + " (" + kKeys.at(k) + ")");
    }
  }
  if (unread.empty()) return {};
  const std::string domain = "onboard domain " + std::to_string(robot.dds.onboard.domain);
  if (read.empty()) {
    return failure("no agent listens on " + domain +
                   "; start the agent first, with the same dds.onboard.domain");
  }
  const bool only_fixes = unread.ends_with("(topics.fix)") && unread.find(", ") == std::string::npos;
  return failure("an agent on " + domain + " reads " + read + ", but nobody reads " + unread +
                 "; the agent " + (only_fixes ? "has gps.use: false or another name" : "has another name") +
                 " for it: give replay the agent's own file with -c, or the same with --set");
}

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
