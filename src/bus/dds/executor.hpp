#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>

#include "fleetmap/core/time.hpp"
#include "work_watchdog.hpp"

namespace fleetmap::bus {

/// Runs posted callbacks and timers, one after the other, on the thread that calls it. Timers that are due
/// and posted callbacks take turns.
class Executor {
 public:
  using Clock = std::chrono::steady_clock;

  static constexpr std::size_t kMaxPosted = 4096;
  /// A callback that runs longer counts as stuck.
  static constexpr Duration kStuckAfter = std::chrono::seconds(2);

  /// From any thread, as the next three. For callers that bound what waits: one callback for each message in
  /// an inbox, one for each work item.
  void post(Work callback);
  /// False, and nothing is posted, while kMaxPosted callbacks wait.
  [[nodiscard]] bool try_post(Work callback);
  /// Makes a waiting run_one return.
  void wake();
  void stop();
  bool stopped() const;

  /// Calls back every `period` (> 0) until the returned function is called, on the callback thread.
  std::function<void()> add_timer(Duration period, Work callback);

  /// Runs what is due next, waiting for it until `deadline` at the longest; false if nothing came or it is
  /// stopped.
  bool run_one(Clock::time_point deadline);

  /// The work of the callback thread.
  const std::shared_ptr<WorkRecord>& record() const { return record_; }

 private:
  struct Timer {
    Duration period;
    Work callback;
    bool active = true;  ///< callback thread only
  };

  std::optional<Work> take_due(Clock::time_point now);
  std::optional<Work> take_timer(Clock::time_point now);

  const std::shared_ptr<WorkRecord> record_ = std::make_shared<WorkRecord>(kStuckAfter);
  mutable std::mutex mutex_;  ///< guards all below
  std::condition_variable changed_;
  std::deque<Work> posted_;
  std::multimap<Clock::time_point, std::shared_ptr<Timer>> timers_;
  bool timer_ran_last_ = false;
  bool woken_ = false;
  bool stopped_ = false;
};

}  // namespace fleetmap::bus
