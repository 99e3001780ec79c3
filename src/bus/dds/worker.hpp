#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include "executor.hpp"
#include "fleetmap/bus/bus.hpp"

namespace fleetmap::bus {

/// One thread that does work items in order and posts what follows each.
class Worker {
 public:
  /// Work that takes longer than `stuck_after` is taken for stuck.
  Worker(std::shared_ptr<Executor> executor, Duration stuck_after);
  /// Waits for the item under way; the others are let go.
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// Waits for the item under way; the others, and those that are added later, are let go.
  void finish();
  /// False, and it is not added, while Bus::kMaxWork items wait.
  bool add(Work work, std::function<void()> done);
  /// The thread's present work.
  const std::shared_ptr<WorkRecord>& record() const { return record_; }

 private:
  struct Item {
    Work work;
    std::function<void()> done;
  };
  void loop();

  std::shared_ptr<Executor> executor_;
  const std::shared_ptr<WorkRecord> record_;
  std::mutex mutex_;  ///< guards items_ and stopping_
  std::condition_variable changed_;
  std::deque<Item> items_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace fleetmap::bus
