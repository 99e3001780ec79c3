#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "fleetmap/bus/stall_detector.hpp"
#include "fleetmap/bus/work.hpp"

namespace fleetmap::bus {

/// Records what one thread does, for a WorkWatchdog that reads it from its own thread.
class WorkRecord {
 public:
  /// Work that ends within `limit` leaves no trace.
  explicit WorkRecord(Duration limit) : limit_(limit) {}
  Duration limit() const { return limit_; }

  /// Runs `work` on the calling thread.
  void run(const Work& work);
  /// The thread's present work, and the long work that ended since the last call.
  ThreadActivity take();

 private:
  static constexpr std::size_t kMaxEnded = 16;
  void begin(const std::string& name);
  void end();

  const Duration limit_;
  std::mutex mutex_;        ///< guards all below; held for copies of a name only
  WorkUnderWay under_way_;  ///< keeps the memory of its name from work to work
  bool busy_ = false;
  std::vector<EndedWork> ended_;
};

/// Logs from a thread of its own when one of several threads is stuck in a piece of work, and when it goes
/// on.
class WorkWatchdog {
 public:
  static constexpr Duration kPeriod = std::chrono::milliseconds(500);

  struct Watched {
    std::string thread;  ///< its name in the log
    std::shared_ptr<WorkRecord> record;
  };
  /// `robot` precedes each line of the log.
  WorkWatchdog(std::string robot, std::vector<Watched> watched, Duration period = kPeriod);
  /// From any thread; one for each watched thread.
  std::vector<StallCounters> counters() const;

 private:
  void run(const std::stop_token& end);
  void check(SteadyTime now);

  const std::string robot_;
  const std::vector<Watched> watched_;
  const Duration period_;
  mutable std::mutex mutex_;  ///< guards detectors_
  std::vector<StallDetector> detectors_;
  std::jthread thread_;
};

}  // namespace fleetmap::bus
