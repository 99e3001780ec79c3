#include "fleet_run.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <ostream>

#include "fleetmap/config/fleet_config.hpp"
#include "fleetmap/config/fleet_file.hpp"
#include "fleetmap/config/override.hpp"
#include "fleetmap/config/recording_config.hpp"
#include "fleetmap/core/cpu_time.hpp"
#include "fleetmap/core/text_list.hpp"
#include "fleetmap/output/trajectory_file.hpp"
#include "options.hpp"
#include "page/live_monitor.hpp"
#include "page/preview_files.hpp"
#include "recordings/recording_feed.hpp"
#include "recordings/recording_input.hpp"
#include "recordings/unread_parts.hpp"
#include "report/report.hpp"
#include "report/run_summary.hpp"
#include "twin_feed.hpp"
#include "twin_results.hpp"
#include "twin_setup.hpp"
#include "version.hpp"
#include "virtual_fleet.hpp"

namespace fleetmap::apps {
namespace {

constexpr Duration kPerceptionTime = std::chrono::milliseconds(40);
constexpr Duration kBackgroundTime = std::chrono::milliseconds(300);

using NamedRecordings = std::vector<std::pair<AgentId, std::filesystem::path>>;

Result<NamedRecordings> recordings_of(const std::vector<std::string>& texts) {
  NamedRecordings recordings;
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals + 1 == text.size())
      return failure("--recording " + text + ": expected NAME=PATH, e.g. r1=drive1");
    const auto id = AgentId::parse(text.substr(0, equals));
    if (!id) return failure("--recording " + text + ": " + id.error().message);
    recordings.emplace_back(*id, text.substr(equals + 1));
  }
  return recordings;
}

CommandResult<config::FleetConfig> fleet_config(const RunOptions& options,
                                                const std::vector<config::Override>& overrides) {
  const auto recordings = recordings_of(options.recordings);
  if (!recordings) return exit_with(kUsage, recordings.error());
  auto config = recordings->empty() ? config::load_fleet(options.config, overrides)
                                    : config::fleet_of(*recordings, overrides);
  if (!config) return exit_with(kBadConfiguration, config.error());
  return std::move(*config);
}

/// The recordings, or the robots of the twin.
Result<std::unique_ptr<FleetFeed>> feed_of(config::FleetConfig& config, const RunOptions& options,
                                           std::optional<TwinSetup>& twin) {
  const unsigned threads = options.threads > 1 ? options.threads : 0;
  config.network.threads = threads;
  if (config.twin) {
    auto setup = set_up_twin(config);
    if (!setup) return tl::unexpected(setup.error());
    // Time that perception and background work take on a robot; it also lets the robots' work overlap.
    config.network.perception_time = kPerceptionTime;
    config.network.background_time = kBackgroundTime;
    std::vector<sim::RobotTwinConfig> robots;
    for (const auto& member : config.members) robots.push_back(member.robot);
    auto feed = TwinFeed::create(setup->world, setup->origin, robots, threads,
                                 std::chrono::hours(options.first_session));
    if (!feed) return tl::unexpected(feed.error());
    twin = std::move(*setup);
    return std::unique_ptr<FleetFeed>(std::move(*feed));
  }
  std::vector<config::RecordingConfig> recordings;
  std::vector<recording::LogClock> log_clocks;
  std::vector<bool> uses_gps;
  for (auto& member : config.members) {
    recordings.push_back(*member.recording);
    const auto prepared = prepare(member.recording->path, member.recording->reader, member.agent.perception);
    if (!prepared) return tl::unexpected(prepared.error());
    log_clocks.push_back(prepared->log_clock);
    uses_gps.push_back(member.agent.perception.uses_gps);
    log_preparation(*prepared, member.agent.id.str());
  }
  return RecordingFeed::create(recordings, log_clocks, config.members.front().agent.site_origin, uses_gps);
}

/// Writes the true trajectory of each robot of the twin and returns them; none from recordings.
Result<std::vector<output::Trajectory>> write_truths(const TwinFeed* twin, const FleetOutcome& outcome) {
  std::vector<output::Trajectory> truths;
  for (std::size_t k = 0; twin != nullptr && k < outcome.agents.size(); ++k) {
    truths.push_back(twin->truth(k));
    const Status written = write_truth(outcome.agents[k].directory, truths.back());
    if (!written) return tl::unexpected(written.error());
  }
  return truths;
}

/// Writes the report into `folder` and prints the summary.
CommandResult<ExitCode> report_outcome(const FleetOutcome& outcome, const RunProfile& profile,
                                       const RunOptions& options, std::ostream& out) {
  RunSettings settings{kVersion, options.config, options.set};
  for (const std::string& recording : options.recordings) append_to_list(settings.configuration, recording);
  const std::string& folder = options.out;
  if (const Status written = write_report(folder, outcome, profile, settings); !written)
    return exit_with(kFailed, written.error());
  print_summary(out, outcome, folder);
  out << summary_of(profile) << '\n';
  const bool whole = std::ranges::all_of(outcome.agents, [](const auto& entry) {
    return (entry.results || !entry.agent) && entry.problem.empty() && !is_damaged(entry.recording);
  });
  return whole ? kDone : kFailed;
}

}  // namespace

CommandResult<ExitCode> run_fleet(const RunOptions& options, std::ostream& out) {
  if (options.config.empty() == options.recordings.empty()) {
    return exit_with(
        kUsage, {"fleetmap run: give either -c FLEET.yaml or --recording NAME=PATH (once for each robot)"});
  }
  const auto overrides = parse_overrides(options.set);
  if (!overrides) return exit_with(kUsage, overrides.error());
  const auto page_config = config_of_page(options.monitor);
  if (!page_config) return exit_with(kUsage, page_config.error());
  auto config = fleet_config(options, *overrides);
  if (!config) return tl::unexpected(config.error());
  if (options.agents && *options.agents > config->members.size()) {
    return exit_with(kUsage,
                     {"--agents " + std::to_string(*options.agents) + ": " + options.config + " has only " +
                      std::to_string(config->members.size()) + " agents; give at most so many"});
  }
  if (options.agents) config->keep_first(*options.agents);
  const auto start = std::chrono::steady_clock::now();
  // Rows of a file may be others than the lanes of the world.
  const bool on_own_drawing = config->twin && config->twin->mission.file.empty();
  const int every = config->twin ? config->twin->mission.rows.every : 1;
  std::optional<TwinSetup> setup;
  auto feed = feed_of(*config, options, setup);
  if (!feed) return exit_with(config->twin ? kBadConfiguration : kFailed, feed.error());
  const auto* twin = dynamic_cast<const TwinFeed*>(feed->get());
  auto fleet = VirtualFleet::create(std::move(*config), std::move(*feed), options.out, options.record,
                                    options.first_session);
  if (!fleet) return exit_with(kFailed, fleet.error());
  if (setup) {
    Status written = write_truth_cloud(options.out, *setup->world);
    if (written) written = write_site(options.out, *setup);
    if (!written) return exit_with(kFailed, written.error());
  }
  const auto page = page_of_run(*page_config, options.out);
  if (!page) return exit_with(kFailed, page.error());
  if (*page) (*fleet)->show_on((*page)->server());
  monitor::PreviewWriter previews(previews_of_run(options.out));
  (*fleet)->keep_previews_in(previews);
  const double cpu_before = process_cpu_seconds();
  auto outcome = (*fleet)->run();
  if (!outcome) return exit_with(kFailed, outcome.error());
  write_or_log(previews);
  const auto truths = write_truths(twin, *outcome);
  if (!truths) return exit_with(kFailed, truths.error());
  if (setup && outcome->completion && on_own_drawing)
    outcome->completion->lane_share = share_of_lanes_driven(*setup->world, every, *truths);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  const RunProfile profile = profile_of(*outcome, cpu_before, process_cpu_seconds(), wall.count());
  return report_outcome(*outcome, profile, options, out);
}

}  // namespace fleetmap::apps
