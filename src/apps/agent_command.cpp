#include <spdlog/spdlog.h>

#include <iostream>
#include <memory>

#include "commands.hpp"
#include "drive_watchdog.hpp"
#include "fleetmap/agent/agent.hpp"
#include "fleetmap/agent/navigator.hpp"
#include "fleetmap/agent/results.hpp"
#include "fleetmap/bus/dds_bus.hpp"
#include "fleetmap/config/fleet_agreement.hpp"
#include "fleetmap/config/fleet_file.hpp"
#include "fleetmap/config/override.hpp"
#include "fleetmap/config/robot_config.hpp"
#include "fleetmap/config/robot_file.hpp"
#include "fleetmap/recording/bag_writer.hpp"
#include "fleetmap/trust/credentials.hpp"
#include "fleetmap/wire/topics.hpp"
#include "link_log.hpp"
#include "live_bus.hpp"
#include "mission_setup.hpp"
#include "options.hpp"
#include "report.hpp"
#include "sample_player.hpp"
#include "twin_setup.hpp"

namespace fleetmap::apps {
namespace {

constexpr Duration kNoScan = std::chrono::seconds(5);
constexpr Duration kReportPeriod = std::chrono::seconds(10);
/// What others get to come back and bring what is missing.
constexpr Duration kPeerPatience = std::chrono::minutes(1);
/// After SIGTERM: until nothing was asked for so long, and at most (service managers kill after ten).
constexpr Duration kQuiet = std::chrono::milliseconds(1500), kFarewell = std::chrono::seconds(5);
constexpr Duration kCheckPeriod = std::chrono::milliseconds(500);
constexpr Duration kTrafficPeriod = std::chrono::seconds(1), kNodesPeriod = std::chrono::milliseconds(50);

struct AgentOptions {
  std::string config;
  std::string record;
  std::string as;
  std::string out = ".";
  double exit_after_idle = 0.0;
  std::vector<std::string> set;
};

/// Writes what arrives on the sensor topics into a bag.
class SensorRecorder {
 public:
  static Result<std::unique_ptr<SensorRecorder>> create(const std::filesystem::path& directory,
                                                        const agent::SensorTopics& topics, bus::Bus& bus) {
    auto writer = recording::BagWriter::create(directory);
    if (!writer) return tl::unexpected(writer.error());
    return std::unique_ptr<SensorRecorder>(new SensorRecorder(std::move(*writer), topics, bus));
  }
  Status close() {
    subscriptions_.clear();
    return writer_.close();
  }

 private:
  SensorRecorder(recording::BagWriter writer, const agent::SensorTopics& topics, bus::Bus& bus)
      : writer_(std::move(writer)) {
    for (const bus::Topic& topic : sensor_topics(topics)) {
      subscriptions_.push_back(bus.subscribe(topic, [this, topic, &bus](const Bytes& cdr) {
        const Status written = writer_.write(topic.name, topic.type, bus.now(), cdr);
        if (!written && !std::exchange(failed_, true))
          spdlog::error("recording stopped: {}", written.error().message);
      }));
    }
  }
  recording::BagWriter writer_;
  bool failed_ = false;
  std::vector<bus::Handle> subscriptions_;
};

/// The LiDAR alone is silent: the rest looks well, but no map is made.
bool misses_scans(const agent::Perception& perception) {
  return perception.last_heard() - perception.last_scan() > kNoScan;
}

void print_progress(const agent::Agent& agent, const bus::Bus& bus) {
  const store::Store& store = agent.store();
  const bool none_yet = agent.perception().counters().scans == 0;
  if (misses_scans(agent.perception())) {
    spdlog::warn(
        "{}: other sensors are heard, but no scan on {} for {:.0f} s: is the LiDAR on? If its driver runs, "
        "start it anew, or look at its shared memory (docs/reference/dds.md, A reader that is killed)",
        agent.config().id.str(), agent.config().perception.topics.points,
        to_seconds(bus.now() - agent.perception().last_scan()));
  } else if (none_yet) {
    spdlog::info("{}: no scan heard yet on {}: is the driver on, with ROS_DOMAIN_ID as dds.onboard.domain?",
                 agent.config().id.str(), agent.config().perception.topics.points);
  }
  if (none_yet) return;
  if (const agent::Navigator* navigator = agent.navigator()) {
    if (const auto reason = navigator->stands())
      spdlog::info("{}: stands still: {}", agent.config().id.str(), to_string(*reason));
    const auto mission = navigator->status();
    spdlog::info("{}: {}, {} of {} rows driven by the fleet, {} to go for this robot",
                 agent.config().id.str(), planning::to_string(mission.state), mission.done, mission.rows,
                 mission.mine);
    for (const auto& row : mission.abandoned) {
      spdlog::warn("{}: row {} is abandoned: {}", agent.config().id.str(), row.row,
                   row.why.empty() ? "other robots gave it up" : row.why);
    }
  }
  spdlog::info("{}: {} scans, {} nodes, {} alignments, {} of {} submaps, last sensor {:.1f} s ago",
               agent.config().id.str(), agent.perception().counters().scans, store.nodes().size(),
               store.alignments().size(), store.submap_set().size(), store.nodes().size(),
               to_seconds(bus.now() - agent.last_sensor()));
}

/// Whether it is time to end by itself: the mission is done or the sensors are silent, the exchange has been
/// silent for `patience`, everything is held, and nobody tells that more will come. Else others get a minute
/// more to come and bring it.
bool time_to_end(agent::Agent& agent, const bus::Bus& bus, Duration patience, bool& rest_frozen) {
  const Duration start_allowance =
      agent.perception().counters().scans == 0 ? kPeerPatience : Duration::zero();
  if (agent.navigator() != nullptr && agent.navigator()->done()) {
    // While the others are still here to take it: at the end they would have gone.
    if (!std::exchange(rest_frozen, true)) {
      agent.freeze_rest();
      return false;
    }
    // Robots that wait beside each other find ever new encounters; what counts is that nobody lacks a map.
    const Duration silence = bus.now() - agent.link_counters().last_submap;
    const bool all_told = agent.complete() && agent.fleet_caught_up();
    return all_told ? silence > patience : silence > patience + kPeerPatience;
  }
  const bool sensors_silent =
      bus.now() - agent.last_sensor() > patience + start_allowance && agent.perception().idle();
  if (!sensors_silent) {
    rest_frozen = false;
    return false;
  }
  if (!std::exchange(rest_frozen, true)) {
    agent.freeze_rest();
    return false;
  }
  const Duration silence = bus.now() - agent.last_exchange();
  const bool settled = agent.idle() && agent.complete() && agent.fleet_caught_up() && !agent.others_busy();
  return settled ? silence > patience : silence > patience + kPeerPatience;
}

void run_until_done(bus::DdsBus& bus, agent::Agent& agent, LinkLog& log, DriveWatchdog* watchdog,
                    double exit_after_idle) {
  const std::atomic<bool>& stop = stop_on_signals();
  const bus::Handle report = bus.every(kReportPeriod, {"progress", [&] { print_progress(agent, bus); }});
  const bus::Handle traffic = bus.every(
      kTrafficPeriod, {"traffic log", [&] {
                         log.add_traffic(bus.take_heard_traffic(), agent.asked_for_submaps(), bus.now());
                       }});
  const bus::Handle nodes =
      bus.every(kNodesPeriod, {"node log", [&] { log.add_nodes(agent.store().nodes(), bus.now()); }});
  bus::Handle check;
  bool rest_frozen = false;
  if (exit_after_idle > 0.0) {
    check = bus.every(kCheckPeriod, {"end of the mission", [&, patience = from_seconds(exit_after_idle)] {
                                       if (time_to_end(agent, bus, patience, rest_frozen)) bus.stop();
                                     }});
  }
  bus.run_until(stop);
  // Before anything that takes time.
  if (watchdog != nullptr) watchdog->stand();
  agent.halt();
  if (rest_frozen) return;
  // Told to end: the last node goes to whoever is in reach, or their maps would lack what this robot's has.
  agent.freeze_rest();
  Stamp busy = bus.now();
  bus.run_until(
      [&] {
        if (!agent.idle()) busy = bus.now();
        return bus.now() - busy > kQuiet;
      },
      kFarewell);
}

/// `directory`, or with a number behind it if it holds a bag of an earlier start.
std::filesystem::path free_folder(const std::filesystem::path& directory) {
  std::filesystem::path folder = directory;
  std::error_code error;
  for (int k = 1; std::filesystem::exists(folder, error); ++k)
    folder = directory.string() + "-" + std::to_string(k);
  return folder;
}

/// The robot of its own file, with its mission planned.
Result<config::RobotConfig> robot_of_its_own(const AgentOptions& options,
                                             const std::vector<config::Override>& overrides) {
  auto robot = config::load_robot(options.config, overrides);
  if (!robot) return robot;
  if (const Status planned = plan_mission(*robot); !planned) return tl::unexpected(planned.error());
  return robot;
}

/// One robot of a fleet's file, as a process of its own on this machine.
Result<config::RobotConfig> member_of_fleet(const AgentOptions& options,
                                            const std::vector<config::Override>& overrides) {
  auto fleet = config::load_fleet(options.config, overrides);
  if (!fleet) return tl::unexpected(fleet.error());
  if (fleet->twin) {
    if (const Status planned = set_up_agents(*fleet); !planned) return tl::unexpected(planned.error());
  }
  for (auto& member : fleet->members) {
    if (member.agent.id.str() != options.as) continue;
    member.agent.directory = std::filesystem::path(options.out) / options.as;
    return config::RobotConfig{std::move(member.agent), std::nullopt, std::move(member.dds),
                               std::move(member.recording)};
  }
  return failure(options.config + ": has no agent '" + options.as + "'");
}

RadioAccess radio_access(const bus::DdsBusConfig& dds, const bus::DdsBus& bus) {
  RadioAccess access{dds.keys != nullptr, {}};
  for (const bus::Link link : {bus::Link::kLongRange, bus::Link::kShortRange}) {
    for (const std::string& notice : bus.survey(link).notices)
      access.refused.push_back(std::string(to_string(link)) + ": " + notice);
  }
  return access;
}

void say_who_may_join(const bus::DdsBusConfig& dds) {
  if (!dds.keys) {
    return spdlog::warn(
        "{}: no keys: anyone on the radios may join, read all and send anything (fleetmap keys)",
        dds.agent.str());
  }
  constexpr auto kSoon = std::chrono::days(30);
  const trust::Certificate& own = dds.keys->certificate;
  const std::string until = trust::date(own.not_after);
  if (own.not_after - std::chrono::system_clock::now() < kSoon) {
    spdlog::warn("{}: its keys are valid until {}: make new ones with `fleetmap keys add {}`",
                 dds.agent.str(), until, own.name.str());
  } else {
    spdlog::info("{}: keys of {} ({}), valid until {}", dds.agent.str(), own.name.str(), to_string(own.role),
                 until);
  }
}

int run(const AgentOptions& options) {
  const auto overrides = parse_overrides(options.set);
  if (!overrides) return report(overrides.error(), kUsage);
  const auto config =
      options.as.empty() ? robot_of_its_own(options, *overrides) : member_of_fleet(options, *overrides);
  if (!config) return report(config.error(), kBadConfiguration);
  auto bus = join_dds(config->dds);
  if (!bus) return report(bus.error(), kBadConfiguration);
  for (const std::string& warning : config::peer_warnings(config->dds, config->agent.exchange))
    spdlog::warn("{}: {}", config->agent.id.str(), warning);
  say_who_may_join(config->dds);
  auto agent = agent::Agent::create(config->agent, **bus);
  if (!agent) return report(agent.error(), kFailed);
  auto log = LinkLog::open(config->agent.directory, config->agent.id);
  if (!log) return report(log.error(), kFailed);
  std::unique_ptr<SensorRecorder> recorder;
  if (!options.record.empty()) {
    auto made = SensorRecorder::create(free_folder(options.record), config->agent.perception.topics, **bus);
    if (!made) return report(made.error(), kFailed);
    recorder = std::move(*made);
  }
  spdlog::info("{}: ready, store {}", config->agent.id.str(),
               (config->agent.directory / "store.db").string());
  std::optional<DriveWatchdog> watchdog;
  if ((*agent)->navigator() != nullptr) watchdog.emplace(**bus, stop_on_signals());
  run_until_done(**bus, **agent, *log, watchdog ? &*watchdog : nullptr, options.exit_after_idle);
  if (recorder) {
    if (const Status closed = recorder->close(); !closed) spdlog::error("{}", closed.error().message);
  }
  // Work under way uses the agent; it must have ended before the agent goes.
  (*agent)->stop();
  (*bus)->finish_work();
  const auto results = agent::write_results((*agent)->store(), (*agent)->config());
  if (!results) spdlog::warn("{}", results.error().message);
  const Status written = write_report(config->agent.directory, **agent, results ? &*results : nullptr,
                                      radio_access(config->dds, **bus), (*bus)->stalls());
  if (!written) return report(written.error(), kFailed);
  if (results) {
    std::cout << (config->agent.directory / "map.ply").string() << "  " << results->map.points
              << " points from " << results->map.submaps << " submaps, " << results->missing_submaps
              << " missing, hash " << results->map.hash << '\n';
  }
  if (const std::string lost = lost_ways((*agent)->perception().odometry_counters()); !lost.empty())
    std::cout << lost << '\n';
  if (results && results->missing_submaps > 0) {
    spdlog::warn(
        "{} submaps are missing: their robots were out of reach; run the agent again near one that has them",
        results->missing_submaps);
  }
  return results ? kDone : kFailed;
}

}  // namespace

void add_agent(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<AgentOptions>();
  CLI::App* command =
      app.add_subcommand("agent", "one robot over DDS; ends with SIGINT or SIGTERM and writes its map");
  command->add_option("-c,--config", options->config, "AGENT.yaml, or FLEET.yaml with --as")->required();
  CLI::Option* as = command->add_option("--as", options->as, "this agent of FLEET.yaml, all on this machine");
  command
      ->add_option(
          "--out", options->out,
          "with --as: the agent keeps its files in OUT/NAME; without, the file's directory says where")
      ->needs(as)
      ->check(some_path());
  command
      ->add_option("--record", options->record, "write the sensor topics as a rosbag2 bag into this folder")
      ->check(some_path());
  command
      ->add_option("--exit-after-idle", options->exit_after_idle,
                   "s; end by itself when sensors and exchange have been silent for so long; a minute later "
                   "while no scan was heard yet, and another while somebody lacks a part of the map")
      ->check(non_negative_number());
  command->add_option("--set", options->set, "key=value, overrides any configuration key")
      ->allow_extra_args(false);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace fleetmap::apps
