#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <memory>
#include <numbers>
#include <optional>

#include "commands.hpp"
#include "fleetmap/agent/trajectory_file.hpp"
#include "fleetmap/config/robot_file.hpp"
#include "fleetmap/core/cpu_time.hpp"
#include "fleetmap/odometry/loam.hpp"
#include "fleetmap/recording/play_times.hpp"
#include "fleetmap/recording/reader.hpp"
#include "fleetmap/sensor/clock_offsets.hpp"
#include "options.hpp"
#include "report.hpp"
#include "way_check.hpp"

namespace fleetmap::apps {
namespace {

struct OdometryOptions {
  std::string recording;
  std::string config;
  std::string out;
  std::vector<std::string> set;
};

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

/// Odometry alone over a recording, with the time that each scan took.
struct OdometryRun {
  std::vector<agent::StampedPose> poses;
  std::vector<double> wall_ms;
  double cpu_s = 0.0;
  std::size_t refused = 0;
  std::string first_refusal;
  std::optional<Stamp> first_lost;
  odometry::LoamCounters counters;
  odometry::LocalMapSize map;  ///< when it was largest
  std::size_t blind = 0;       ///< scans that left a direction of the motion to the prior
  WayCheck way;
};

/// Whether the odometry kept its way, as far as it can tell; what it lost is printed.
bool kept_its_way(const OdometryRun& run) {
  const odometry::LoamCounters& counters = run.counters;
  const Matrix6d C = run.way.covariance();
  const double sigma = std::sqrt(C.topLeftCorner<3, 3>().trace());
  std::cout << "length " << run.way.length() << " m, stated to " << sigma << " m and "
            << std::sqrt(C.bottomRightCorner<3, 3>().trace()) * 180.0 / std::numbers::pi
            << " deg (1 sigma) at its end\n";
  if (run.blind > 0) {
    std::cout << run.blind << " of " << counters.updates
              << " scans show the motion in some directions only; there it follows from the scans before, "
                 "gyro and wheels\n";
  }
  if (counters.refused_repeated > 0) {
    std::cout
        << counters.refused_repeated
        << " scans have the very points of the scan before while the robot moves: the LiDAR's driver hangs\n";
  }
  if (counters.lost > 0) {
    std::cout << "lost " << counters.lost << " of " << counters.updates << " scans, the first "
              << to_seconds(*run.first_lost - run.poses.front().stamp)
              << " s after the start: the poses there are predictions\n";
  }
  if (counters.map_restarts > 0) {
    std::cout << "the local map was begun anew " << counters.map_restarts
              << " times: poses before and after do not belong together\n";
  }
  if (counters.map_overflows > 0) {
    std::cout << "the local map was full " << counters.map_overflows
              << " times, and what lay farthest was forgotten: scans do not belong together, or "
                 "odometry.map_radius asks for more than the map holds\n";
  }
  const std::vector<std::string> doubts = run.way.doubts();
  for (const std::string& doubt : doubts) std::cout << doubt << '\n';
  return counters.map_restarts == 0 && doubts.empty();
}

/// Feeds a recording's samples to the odometry. Some recordings hold a scan at its start, before what gyro
/// and wheels saw during its sweep, so scans wait until these have passed their end.
class OdometryFeed {
 public:
  OdometryFeed(const agent::PerceptionConfig& config, const recording::LogClock& log_clock)
      : config_(config), loam_(config.odometry, config.lidar), times_(log_clock) {}

  /// `recorded` as Reader::recorded() has it.
  void add(recording::Sample sample, std::optional<Stamp> recorded) {
    if (!correct_clock(sample, recorded)) return;
    if (auto* scan = std::get_if<sensor::Scan>(&sample)) {
      const Stamp end = sensor::end_of(*scan);
      waiting_.push_back({std::move(*scan), end});
    } else if (const auto* imu = std::get_if<sensor::Imu>(&sample);
               imu != nullptr && config_.odometry_uses_imu) {
      loam_.add_imu(*imu);
      imu_ = imu->stamp;
    } else if (const auto* wheel = std::get_if<sensor::Wheel>(&sample);
               wheel != nullptr && config_.odometry_uses_wheel) {
      loam_.add_wheel(*wheel);
      wheel_ = wheel->stamp;
    }
    while (!waiting_.empty() && due(waiting_.front())) {
      add_scan(waiting_.front().scan);
      waiting_.pop_front();
    }
  }
  OdometryRun finish() {
    for (const Waiting& waiting : waiting_) add_scan(waiting.scan);
    run_.counters = loam_.counters();
    return std::move(run_);
  }

 private:
  /// So far may a sensor that was heard lag behind; one that lags more has stopped.
  static constexpr Duration kPatience = std::chrono::milliseconds(250);

  struct Waiting {
    sensor::Scan scan;
    Stamp end;  ///< of its sweep
  };

  /// False while it is too early to tell what the stamp means.
  bool correct_clock(recording::Sample& sample, std::optional<Stamp> recorded) {
    const auto source = static_cast<sensor::Source>(sample.index());  // the order of both is the same
    now_ = std::max(now_, times_.of(sample, recorded));
    clocks_.add(source, recording::stamp_of(sample), now_);
    for (const std::string& news : clocks_.take_news()) spdlog::warn("{}", news);
    std::visit([&](auto& s) { s.stamp += clocks_.correction(source); }, sample);
    return !clocks_.unclear(source);
  }

  bool due(const Waiting& first) const {
    const bool seen_through = (!imu_ || *imu_ >= first.end) && (!wheel_ || *wheel_ >= first.end);
    return seen_through || waiting_.back().scan.stamp - first.scan.stamp > kPatience;
  }

  void add_scan(const sensor::Scan& scan) {
    const double cpu = thread_cpu_seconds();
    const auto start = std::chrono::steady_clock::now();
    const auto update = loam_.add_scan(scan);
    run_.wall_ms.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    run_.cpu_s += thread_cpu_seconds() - cpu;
    for (const std::string& news : loam_.take_news()) spdlog::warn("{}", news);
    if (const odometry::LocalMapSize map = loam_.map_size(); map.bytes > run_.map.bytes) run_.map = map;
    if (update) {
      run_.poses.push_back({update->stamp, update->T_odom_base});
      run_.way.add(*update);
      run_.blind += update->degenerate_count > 0;
      if (update->lost && !run_.first_lost) run_.first_lost = update->stamp;
    } else if (run_.refused++ == 0) {
      run_.first_refusal = update.error().message;
    }
  }

  const agent::PerceptionConfig& config_;
  odometry::Loam loam_;
  OdometryRun run_;
  std::deque<Waiting> waiting_;
  std::optional<Stamp> imu_, wheel_;  ///< last heard
  recording::PlayTimes times_;
  sensor::ClockOffsets clocks_;
  Stamp now_{};
};

Result<OdometryRun> run_odometry(recording::Reader& reader, const recording::LogClock& log_clock,
                                 const agent::PerceptionConfig& config) {
  OdometryFeed feed(config, log_clock);
  while (true) {
    auto sample = reader.next();
    if (!sample) return tl::unexpected(sample.error());
    if (!*sample) return feed.finish();
    feed.add(std::move(**sample), reader.recorded());
  }
}

int run(const OdometryOptions& options) {
  const auto overrides = parse_overrides(options.set);
  if (!overrides) return report(overrides.error(), kUsage);
  std::optional<std::filesystem::path> file;
  if (!options.config.empty()) file = options.config;
  const auto config = config::load_sensors(file, *overrides);
  if (!config) return report(config.error(), kBadConfiguration);
  const recording::ReaderConfig reader_config =
      config->recording ? config->recording->reader : recording::ReaderConfig{};
  const std::filesystem::path folder = std::filesystem::path(options.out).parent_path();
  if (const Status writable = check_writable(folder.empty() ? "." : folder); !writable)
    return report(writable.error(), kFailed);
  auto reader = recording::open(options.recording, reader_config);
  if (!reader) return report(reader.error(), kFailed);
  const auto log_clock = recording::find_log_clock(options.recording, reader_config);
  if (!log_clock) return report(log_clock.error(), kFailed);
  const auto done = run_odometry(**reader, *log_clock, config->agent.perception);
  if (!done) return report(done.error(), kFailed);
  if (done->poses.empty()) {
    return report({options.recording + ": no scan could be used" +
                   (done->first_refusal.empty() ? "" : ": " + done->first_refusal)},
                  kFailed);
  }
  if (const Status written = agent::write_trajectory(options.out, done->poses); !written)
    return report(written.error(), kFailed);
  const Distribution ms = distribution(done->wall_ms);
  std::cout << std::fixed << std::setprecision(2) << "scans " << done->wall_ms.size() << "  mean " << ms.mean
            << " ms  p50 " << ms.p50 << " ms  p99 " << ms.p99 << " ms  max " << ms.max << " ms  CPU "
            << 1e3 * done->cpu_s / static_cast<double>(done->wall_ms.size()) << " ms/scan  peak "
            << peak_megabytes() << " MB\n";
  for (const auto& [stage, seconds] : done->counters.cpu.named())
    std::cout << stage << ' ' << 1e3 * seconds / static_cast<double>(done->wall_ms.size()) << " ms  ";
  std::cout << "\nlocal map at most " << done->map.windows << " windows, "
            << static_cast<double>(done->map.bytes) / (1024.0 * 1024.0) << " MB\n";
  if (done->refused > 0)
    std::cout << "refused " << done->refused << " scans, first: " << done->first_refusal << '\n';
  for (const auto& [name, count] : (*reader)->counters().named()) {
    if (count > 0) std::cout << name << ' ' << count << '\n';
  }
  if (!kept_its_way(*done))
    return report({"the odometry lost its way; the trajectory is not to be relied on"}, kFailed);
  return kDone;
}

}  // namespace

void add_odometry(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<OdometryOptions>();
  CLI::App* command =
      app.add_subcommand("odometry", "odometry alone: a recording in, a TUM trajectory of base_link out");
  command
      ->add_option("recording", options->recording,
                   "rosbag2 folder or .db3, KITTI folder, or a folder of scans")
      ->required();
  command->add_option("--out", options->out, "TUM file")->required()->check(some_path());
  command->add_option("-c,--config", options->config, "AGENT.yaml or FLEET.yaml for the sensors");
  command->add_option("--set", options->set, "key=value, e.g. lidar.model=hdl64e")->allow_extra_args(false);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace fleetmap::apps
