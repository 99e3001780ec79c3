#include "agent_run.hpp"

#include <spdlog/spdlog.h>

#include <memory>
#include <ostream>

#include "agent_lifetime.hpp"
#include "devices/live_devices.hpp"
#include "drive_watchdog.hpp"
#include "fleetmap/agent/agent.hpp"
#include "fleetmap/agent/navigator.hpp"
#include "fleetmap/bus/dds_bus.hpp"
#include "fleetmap/config/fleet_agreement.hpp"
#include "fleetmap/config/fleet_file.hpp"
#include "fleetmap/config/override.hpp"
#include "fleetmap/config/robot_config.hpp"
#include "fleetmap/config/robot_file.hpp"
#include "fleetmap/core/utc.hpp"
#include "fleetmap/output/results.hpp"
#include "fleetmap/recording/bag_writer.hpp"
#include "fleetmap/trust/credentials.hpp"
#include "link_log.hpp"
#include "live_bus.hpp"
#include "mission_setup.hpp"
#include "options.hpp"
#include "page/live_monitor.hpp"
#include "page/live_publisher.hpp"
#include "page/monitor_access.hpp"
#include "page/preview_files.hpp"
#include "report/report.hpp"
#include "ros_publisher.hpp"
#include "sensor_recorder.hpp"
#include "twin/twin_setup.hpp"
#include "version.hpp"

namespace fleetmap::apps {
namespace {

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
                               std::move(member.recording), member.ros};
  }
  return failure(options.config + ": has no agent '" + options.as + "'");
}

RadioAccess radio_access(const bus::DdsBusConfig& dds, const bus::DdsBus& bus) {
  RadioAccess access{dds.keys != nullptr, {}, {}};
  for (const bus::Link link : {bus::Link::kLongRange, bus::Link::kShortRange}) {
    const bus::RadioSurvey survey = bus.survey(link);
    const auto add = [&](const std::vector<std::string>& sentences, std::vector<std::string>& to) {
      for (const std::string& one : sentences) to.push_back(std::string(to_string(link)) + ": " + one);
    };
    add(survey.refused, access.refused);
    add(survey.different_settings, access.different_settings);
  }
  return access;
}

/// Logs whose keys the robot has, or that anyone may join.
void log_keys(const bus::DdsBusConfig& dds) {
  if (!dds.keys) {
    return spdlog::warn(
        "{}: no keys: anyone on the radios may join, read all and send anything (fleetmap keys)",
        dds.agent.str());
  }
  constexpr auto kSoon = std::chrono::days(30);
  const trust::Certificate& own = dds.keys->certificate;
  const std::string until = trust::date(own.not_after);
  if (own.not_after - system_now() < kSoon) {
    spdlog::warn("{}: its keys are valid until {}: make new ones with `fleetmap keys add {}`",
                 dds.agent.str(), until, own.name.str());
  } else {
    spdlog::info("{}: keys of {} ({}), valid until {}", dds.agent.str(), own.name.str(), to_string(own.role),
                 until);
  }
}

/// Null without a folder.
Result<std::unique_ptr<SensorRecorder>> recorder_into(const RecordOptions& options,
                                                      const config::RobotConfig& config, bus::Bus& bus) {
  if (options.folder.empty()) return std::unique_ptr<SensorRecorder>();
  return SensorRecorder::create(options, config.agent.perception.topics, config.ros.publish, bus);
}

/// Null if it is switched off.
std::unique_ptr<RosPublisher> ros_publisher_of(const ros_output::RosOutputConfig& config, agent::Agent& agent,
                                               bus::DdsBus& bus, const LinkLog& log) {
  if (!config.publish) return nullptr;
  return std::make_unique<RosPublisher>(
      agent, bus, config,
      RosPublisher::Edges{
          [&bus](const bus::Topic& topic) { return bus.matches(topic).readers; },
          [&bus](std::function<void()> work, std::function<void()> done) {
            return bus.offload(bus::Lane::kBackground, {"ROS 2 map", std::move(work)}, std::move(done));
          },
          [&log] { return log.last_heard(); }});
}

void print_map(std::ostream& out, const std::filesystem::path& directory, const output::Results& results) {
  out << (directory / "map.ply").string() << "  " << results.map.points << " points from "
      << results.map.submaps << " submaps, " << results.missing_submaps << " missing, hash "
      << results.map.hash << '\n';
}

/// Writes the map and the report of an agent whose work has ended; it began at `begun`.
CommandResult<ExitCode> write_outcome(const config::RobotConfig& config, agent::Agent& agent,
                                      const bus::DdsBus& bus, Stamp begun, const AgentOptions& options,
                                      std::ostream& out) {
  monitor::PreviewWriter previews(previews_of_store(config.agent.directory / "store.db"));
  const auto results =
      output::write_results(agent.store(), agent.config().results(), {}, previews.loader(agent.store()));
  write_or_log(previews);
  if (!results) spdlog::warn("{}", results.error().message);
  const Status written =
      write_report(agent, results, {radio_access(config.dds, bus), bus.stalls(), bus.now() - begun},
                   {kVersion, options.config, options.set});
  if (!written) return exit_with(kFailed, written.error());
  if (results) print_map(out, config.agent.directory, *results);
  out << "report: " << (config.agent.directory / "report.html").string() << '\n';
  if (const std::string lost = lost_ways(agent.perception().odometry_counters()); !lost.empty())
    out << lost << '\n';
  if (results && results->missing_submaps > 0) {
    spdlog::warn(
        "{} submaps are missing: their robots were out of reach; run the agent again near one that has them",
        results->missing_submaps);
  }
  return results ? kDone : kFailed;
}

}  // namespace

CommandResult<ExitCode> run_agent(const AgentOptions& options, std::ostream& out) {
  const auto overrides = parse_overrides(options.set);
  if (!overrides) return exit_with(kUsage, overrides.error());
  const auto page_config = config_of_page(options.monitor);
  if (!page_config) return exit_with(kUsage, page_config.error());
  auto config =
      options.as.empty() ? robot_of_its_own(options, *overrides) : member_of_fleet(options, *overrides);
  if (!config) return exit_with(kBadConfiguration, config.error());
  config->agent.perception.frame_patience = agent::kFramePatience;
  auto bus = join_dds(config->dds);
  if (!bus) return exit_with(kBadConfiguration, bus.error());
  const Stamp begun = (*bus)->now();
  for (const std::string& warning : config::peer_warnings(config->dds, config->agent.exchange))
    spdlog::warn("{}: {}", config->agent.id.str(), warning);
  log_keys(config->dds);
  auto agent = agent::Agent::create(config->agent, **bus);
  if (!agent) return exit_with(kFailed, agent.error());
  auto log = LinkLog::open(config->agent.directory, config->agent.id);
  if (!log) return exit_with(kFailed, log.error());
  const auto recorder = recorder_into(options.record, *config, **bus);
  if (!recorder) return exit_with(kFailed, recorder.error());
  const auto lidar = publish_lidar(config->agent.perception, **bus);
  if (!lidar) return exit_with(kFailed, lidar.error());
  const auto devices = publish_devices(config->agent.perception, **bus);
  if (!devices) return exit_with(kBadConfiguration, devices.error());
  const auto page = page_of_robot(*page_config, config->agent.directory);
  if (!page) return exit_with(kFailed, page.error());
  const auto ros = ros_publisher_of(config->ros, **agent, **bus, *log);
  spdlog::info("{}: ready, store {}", config->agent.id.str(),
               (config->agent.directory / "store.db").string());
  std::optional<DriveWatchdog> watchdog;
  if ((*agent)->navigator() != nullptr) watchdog.emplace(**bus, stop_on_signals());
  std::optional<LivePublisher> live;
  if (*page) {
    live.emplace(**agent, **bus, (*page)->server(), who_may_join(config->dds.keys != nullptr),
                 [&bus](std::function<void()> work) {
                   return (*bus)->post({"order of a viewer", std::move(work)});
                 });
  }
  run_until_done(**bus, **agent, *log, watchdog ? &*watchdog : nullptr, live ? &*live : nullptr,
                 options.exit_after_idle, stop_on_signals());
  if (*recorder) static_cast<void>((*recorder)->close());  // a failure is its problem()
  // Work under way uses the agent; it must have ended before the agent goes.
  (*agent)->stop();
  (*bus)->finish_work();
  const auto outcome = write_outcome(*config, **agent, **bus, begun, options, out);
  if (!*recorder || (*recorder)->problem().empty()) return outcome;
  out << "the recording ends before the drive: " << (*recorder)->problem() << '\n';
  return outcome ? CommandResult<ExitCode>(kFailed) : outcome;
}

}  // namespace fleetmap::apps
