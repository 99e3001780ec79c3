#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/core/time.hpp"

namespace fleetmap::bus {

using SteadyTime = std::chrono::steady_clock::time_point;

/// A piece of work that a thread runs, or ran.
struct WorkUnderWay {
  std::uint64_t number = 0;  ///< of this work among all of its thread
  std::string name;
  SteadyTime begun;
};
/// A piece of work that has ended, by the steady clock.
struct EndedWork {
  WorkUnderWay work;
  SteadyTime ended;
};

/// Work of a thread since the last check: long work that ended, and the work under way.
struct ThreadActivity {
  std::vector<EndedWork> ended;
  std::optional<WorkUnderWay> under_way;
};

/// A sentence for the log about one piece of work that took too long.
struct StallNews {
  std::string text;
  bool goes_on = false;  ///< of a stall that was reported before
};

/// Counts the stalls of one thread.
struct StallCounters {
  std::string thread;
  std::uint64_t times = 0;
  Duration longest{};
  std::string longest_work;
};

/// Finds the work that keeps one thread busy for longer than its limit.
class StallDetector {
 public:
  /// A check that is later than this shows that the whole process was paused (stopped, suspended, or without
  /// CPU); that time does not count as the work's.
  static constexpr Duration kMaxCheckInterval = std::chrono::milliseconds(1500);

  /// Each thread logs a line a minute at most, however slow the computer is.
  static constexpr Duration kReportPeriod = std::chrono::minutes(1);

  StallDetector(std::string thread, Duration limit);
  /// Reports a stall when it is noticed and when it is over, and those that follow within a minute as one
  /// line with their count.
  std::vector<StallNews> check(SteadyTime now, const ThreadActivity& activity);
  const StallCounters& counters() const { return counters_; }

 private:
  struct Pause {
    SteadyTime begun, ended;
  };
  void note_pause(SteadyTime now, const ThreadActivity& activity);
  /// From `begun` to `ended`, without the pauses of the process.
  Duration taken(SteadyTime begun, SteadyTime ended) const;
  /// Counts the stall; true if it is new.
  bool count(const WorkUnderWay& work, Duration lasted);
  /// As count(). Adds a line unless there was one within the last minute.
  bool report(SteadyTime now, const WorkUnderWay& work, Duration lasted, const char* how,
              std::vector<StallNews>& news);
  std::string summary(SteadyTime now) const;

  Duration limit_;
  StallCounters counters_;
  std::optional<SteadyTime> last_check_;
  std::vector<Pause> pauses_;              ///< that the work under way has seen
  std::optional<std::uint64_t> counted_;   ///< the work that was counted last
  std::optional<std::uint64_t> reported_;  ///< the work that has a line of its own
  std::optional<SteadyTime> reported_at_;  ///< the last line
  StallCounters more_;                     ///< stalls since then, without lines of their own
};

}  // namespace fleetmap::bus
