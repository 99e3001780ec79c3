#include "work_watchdog.hpp"

#include <spdlog/spdlog.h>

#include <condition_variable>
#include <utility>

namespace fleetmap::bus {

void WorkRecord::run(const Work& work) {
  struct Ending {
    WorkRecord& record;
    ~Ending() { record.end(); }
  };
  begin(work.name);
  const Ending ending{*this};
  work.run();
}

void WorkRecord::begin(const std::string& name) {
  const std::scoped_lock lock(mutex_);
  ++under_way_.number;
  under_way_.name = name.empty() ? "work without a name" : name;
  under_way_.begun = std::chrono::steady_clock::now();
  busy_ = true;
}

void WorkRecord::end() {
  const SteadyTime now = std::chrono::steady_clock::now();
  const std::scoped_lock lock(mutex_);
  busy_ = false;
  if (now - under_way_.begun < limit_) return;
  if (ended_.size() < kMaxEnded) ended_.push_back({under_way_, now});
}

ThreadActivity WorkRecord::take() {
  const std::scoped_lock lock(mutex_);
  ThreadActivity activity{std::exchange(ended_, {}), std::nullopt};
  if (busy_) activity.under_way = under_way_;
  return activity;
}

WorkWatchdog::WorkWatchdog(std::string robot, std::vector<Watched> watched, Duration period)
    : robot_(std::move(robot)), watched_(std::move(watched)), period_(period) {
  for (const Watched& thread : watched_) detectors_.emplace_back(thread.thread, thread.record->limit());
  thread_ = std::jthread([this](const std::stop_token& end) { run(end); });
}

std::vector<StallCounters> WorkWatchdog::counters() const {
  const std::scoped_lock lock(mutex_);
  std::vector<StallCounters> all;
  for (const StallDetector& detector : detectors_) all.push_back(detector.counters());
  return all;
}

void WorkWatchdog::run(const std::stop_token& end) {
  std::mutex mutex;
  std::condition_variable_any ended;
  std::unique_lock lock(mutex);
  while (!ended.wait_for(lock, end, period_, [&] { return end.stop_requested(); }))
    check(std::chrono::steady_clock::now());
}

void WorkWatchdog::check(SteadyTime now) {
  std::vector<StallNews> news;
  {
    const std::scoped_lock lock(mutex_);
    for (std::size_t k = 0; k < watched_.size(); ++k) {
      for (StallNews& stall : detectors_[k].check(now, watched_[k].record->take()))
        news.push_back(std::move(stall));
    }
  }
  for (const StallNews& stall : news)
    spdlog::log(stall.goes_on ? spdlog::level::warn : spdlog::level::err, "{}: {}", robot_, stall.text);
}

}  // namespace fleetmap::bus
