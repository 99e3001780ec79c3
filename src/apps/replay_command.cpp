#include <algorithm>
#include <chrono>
#include <iostream>
#include <memory>

#include "commands.hpp"
#include "fleetmap/bus/dds_bus.hpp"
#include "fleetmap/config/robot_config.hpp"
#include "fleetmap/config/robot_file.hpp"
#include "fleetmap/recording/reader.hpp"
#include "fleetmap/recording/survey.hpp"
#include "live_bus.hpp"
#include "options.hpp"
#include "recording_player.hpp"
#include "sample_player.hpp"

namespace fleetmap::apps {
namespace {

constexpr Duration kLinger = std::chrono::seconds(1);

struct ReplayOptions {
  std::string recording;
  std::string config;
  std::string as;
  double rate = 1.0;
  double wait_for_reader = 30.0;
  std::vector<std::string> set;
};

Result<config::RobotConfig> replay_config(const ReplayOptions& options) {
  const auto overrides = parse_overrides(options.set);
  if (!overrides) return tl::unexpected(overrides.error());
  std::optional<std::filesystem::path> file;
  if (!options.config.empty()) file = options.config;
  auto robot = config::load_sensors(file, *overrides);
  if (!robot) return robot;
  if (!options.as.empty()) {
    const auto id = AgentId::parse(options.as);
    if (!id) return failure("--as: " + id.error().message);
    robot->agent.id = *id;
  }
  robot->dds.agent = robot->agent.id;
  // A replay stands in for the sensors: it has no business on the radios.
  robot->dds.long_range.enabled = false;
  robot->dds.short_range.enabled = false;
  return robot;
}

int run(const ReplayOptions& options) {
  auto robot = replay_config(options);
  if (!robot) return report(robot.error(), kBadConfiguration);
  recording::ReaderConfig reader_config;
  std::filesystem::path path = options.recording;
  if (robot->recording) {
    reader_config = robot->recording->reader;
    if (path.empty()) path = robot->recording->path;
  }
  if (path.empty())
    return report({"fleetmap replay: name a recording, or give -c a file with recording.path"}, kUsage);
  auto reader = recording::open(path, reader_config);
  if (!reader) return report(reader.error(), kFailed);
  auto bus = join_dds(robot->dds);
  if (!bus) return report(bus.error(), kBadConfiguration);

  const std::atomic<bool>& stop = stop_on_signals();
  const agent::SensorTopics& names = robot->agent.perception.topics;
  const auto survey = recording::survey(path, reader_config);
  if (!survey) return report(survey.error(), kFailed);
  RecordingPlayer player(**reader, *survey, **bus, names, options.rate);
  const auto matched = [&] {
    return stop || std::ranges::all_of(sensor_topics(names), [&](const bus::Topic& topic) {
             return (*bus)->matches(topic).readers > 0;
           });
  };
  const bus::Handle wake = (*bus)->every(std::chrono::milliseconds(50), [] {});
  if (!(*bus)->run_until(matched, from_seconds(options.wait_for_reader))) {
    return report(
        {"fleetmap replay: no agent listens on onboard domain " + std::to_string(robot->dds.onboard.domain) +
         " after " + std::to_string(options.wait_for_reader) +
         " s; start the agent first, with the same dds.onboard.domain"},
        kFailed);
  }
  if (const Status started = player.start(); !started)
    return report({path.string() + ": " + started.error().message}, kFailed);
  (*bus)->run_until([&] { return stop || player.done(); }, Duration::max());
  // The last samples leave from a thread of Fast DDS; a participant that goes at once would take them along.
  (*bus)->run_until([&] { return stop.load(); }, kLinger);
  if (!player.error().empty()) return report({player.error()}, kFailed);
  std::cout << "played " << player.played() << " samples of " << path.string() << '\n';
  for (const auto& [name, count] : (*reader)->counters().named()) {
    if (count > 0) std::cout << "  " << name << ": " << count << '\n';
  }
  return kDone;
}

}  // namespace

void add_replay(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ReplayOptions>();
  CLI::App* command = app.add_subcommand("replay", "plays a recording onto a robot's onboard domain");
  command->add_option("recording", options->recording,
                      "rosbag2 folder, .db3, .mcap, .bag or .pcap, KITTI folder, or a folder of scans");
  command->add_option("-c,--config", options->config,
                      "AGENT.yaml: its dds.onboard and recording keys are used");
  command->add_option("--as", options->as, "play as this robot");
  command->add_option("--rate", options->rate, "times real time")->check(CLI::Range(0.01, 100.0));
  command->add_option("--wait", options->wait_for_reader, "s to wait for an agent that listens")
      ->check(non_negative_number());
  command->add_option("--set", options->set, "key=value, overrides any configuration key")
      ->allow_extra_args(false);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace fleetmap::apps
