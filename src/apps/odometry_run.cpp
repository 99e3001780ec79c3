#include "odometry_run.hpp"

#include <algorithm>
#include <chrono>
#include <deque>
#include <iterator>
#include <utility>

#include "fleetmap/core/cpu_time.hpp"
#include "fleetmap/sensor/turn_direction.hpp"
#include "sample_check.hpp"

namespace fleetmap::apps {
namespace {

/// Feeds a recording's samples to the odometry. Some recordings hold a scan at its start, before what gyro
/// and wheels saw during its sweep, so scans wait until these have passed their end.
class OdometryFeed {
 public:
  OdometryFeed(const agent::PerceptionConfig& config, const recording::LogClock& log_clock,
               const SampleObservers& observers)
      : config_(config),
        observers_(observers),
        loam_(config.odometry, config.lidar),
        check_(log_clock, config),
        turns_(config.odometry.T_base_lidar.linear(), config.odometry.q_base_imu) {}

  /// `recorded` as Reader::recorded() has it.
  void add(recording::Sample sample, std::optional<Stamp> recorded) {
    if (observers_.as_read) observers_.as_read(sample);
    const bool sound = check_.admit(sample, recorded);
    take_warnings();
    if (!sound) return;
    if (observers_.as_used) observers_.as_used(sample);
    if (const auto* imu = std::get_if<sensor::Imu>(&sample)) turns_.add(*imu);
    if (const auto* wheel = std::get_if<sensor::Wheel>(&sample)) turns_.add(*wheel);
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
    take_warnings();
    run_.counters = loam_.counters();
    // While it keeps its way, the odometry's own turns are compared.
    const auto finding = run_.kept_its_way() ? std::nullopt : turns_.finding();
    if (finding && std::ranges::find(run_.findings, *finding) == run_.findings.end())
      run_.findings.push_back(*finding);
    return std::move(run_);
  }

 private:
  /// So far may a sensor that was heard lag behind; one that lags more has stopped.
  static constexpr Duration kPatience = std::chrono::milliseconds(250);

  struct Waiting {
    sensor::Scan scan;
    Stamp end;  ///< of its sweep
  };

  bool due(const Waiting& first) const {
    const bool covered = (!imu_ || *imu_ >= first.end) && (!wheel_ || *wheel_ >= first.end);
    return covered || waiting_.back().scan.stamp - first.scan.stamp > kPatience;
  }

  void take_warnings() { std::ranges::move(check_.take_warnings(), std::back_inserter(run_.findings)); }

  void add_scan(const sensor::Scan& scan) {
    turns_.add(scan);
    const double cpu = thread_cpu_seconds();
    const auto start = std::chrono::steady_clock::now();
    const auto update = loam_.add_scan(scan);
    run_.wall_ms.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    run_.cpu_s += thread_cpu_seconds() - cpu;
    std::ranges::move(loam_.take_warnings(), std::back_inserter(run_.findings));
    if (const odometry::LocalMapSize map = loam_.map_size(); map.bytes > run_.map.bytes) run_.map = map;
    if (update) {
      check_.add_motion(*update);
      run_.poses.push_back({update->stamp, update->T_odom_base});
      run_.way.add(*update);
      run_.blind += update->degenerate_count > 0;
      if (update->lost && !run_.first_lost) run_.first_lost = update->stamp;
    } else if (run_.refused++ == 0) {
      run_.first_refusal = update.error().message;
    }
  }

  const agent::PerceptionConfig& config_;
  const SampleObservers& observers_;
  odometry::Loam loam_;
  OdometryRun run_;
  std::deque<Waiting> waiting_;
  std::optional<Stamp> imu_, wheel_;  ///< last heard
  SampleCheck check_;
  sensor::TurnDirection turns_;
};

}  // namespace

Result<OdometryRun> run_odometry(recording::Reader& reader, const recording::LogClock& log_clock,
                                 const agent::PerceptionConfig& config, const SampleObservers& observers) {
  OdometryFeed feed(config, log_clock, observers);
  while (true) {
    auto sample = reader.next();
    if (!sample) return tl::unexpected(sample.error());
    if (!*sample) return feed.finish();
    feed.add(std::move(**sample), reader.recorded());
  }
}

}  // namespace fleetmap::apps
