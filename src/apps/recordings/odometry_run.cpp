#include "odometry_run.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "sample_check.hpp"

namespace fleetmap::apps {
namespace {

/// Feeds a recording's samples to the odometry.
class OdometryFeed {
 public:
  OdometryFeed(const agent::PerceptionConfig& config, const recording::LogClock& log_clock,
               const SampleObservers& observers)
      : observers_(observers), odometry_(config), check_(log_clock, config) {}

  /// `recorded` as Reader::recorded() has it.
  void add(recording::Sample sample, std::optional<Stamp> recorded) {
    if (observers_.as_read) observers_.as_read(sample);
    const bool sound = check_.admit(sample, recorded);
    take_warnings();
    if (!sound) return;
    if (observers_.as_used) observers_.as_used(sample);
    inputs_.add(std::move(sample));
    while (const auto input = inputs_.take_due()) add_scan(*input);
  }
  OdometryRun finish() {
    while (const auto input = inputs_.take()) add_scan(*input);
    take_warnings();
    OdometryRun run = odometry_.run();
    run.findings = std::move(findings_);
    run.notes = check_.health().gaps();
    return run;
  }

 private:
  void take_warnings() { std::ranges::move(check_.take_warnings(), std::back_inserter(findings_)); }

  void add_scan(const SweepInput& input) {
    const auto update = odometry_.add(input);
    for (std::string& finding : odometry_.take_findings()) check_.add_finding(std::move(finding));
    if (update) check_.add_motion(*update);
  }

  const SampleObservers& observers_;
  SweepInputs inputs_;
  ScanOdometry odometry_;
  SampleCheck check_;
  std::vector<std::string> findings_;
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
