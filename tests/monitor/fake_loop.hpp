#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>

#include "monitor/event_loop.hpp"

namespace fleetmap::testing {

/// An event loop that the test runs step by step. Tasks of a later time wait until the test skips the wait.
class FakeLoop : public monitor::EventLoop {
 public:
  void post(Task task) override {
    {
      const std::scoped_lock lock(mutex_);
      tasks_.push_back(std::move(task));
    }
    posted_.notify_one();
  }
  void post_at(Clock::time_point time, Task task) override {
    if (time <= Clock::now()) return post(std::move(task));
    later_.emplace(time, std::move(task));
  }

  /// False if no task is due.
  bool run_one() {
    std::unique_lock lock(mutex_);
    if (tasks_.empty()) return false;
    const Task task = std::move(tasks_.front());
    tasks_.pop_front();
    lock.unlock();
    task();
    return true;
  }
  void run() {
    while (run_one()) {
    }
  }
  /// Runs the next task, also one that another thread posts within `patience`; false if none came.
  bool wait_and_run_one(std::chrono::seconds patience) {
    {
      std::unique_lock lock(mutex_);
      if (!posted_.wait_for(lock, patience, [&] { return !tasks_.empty(); })) return false;
    }
    return run_one();
  }
  /// Makes due what waits for a time; returns the longest of these waits from now.
  Clock::duration skip_wait() {
    Clock::duration longest{};
    for (auto& [time, task] : later_) {
      longest = std::max(longest, time - Clock::now());
      post(std::move(task));
    }
    later_.clear();
    return longest;
  }

 private:
  std::multimap<Clock::time_point, Task> later_;
  std::mutex mutex_;  ///< of `tasks_`
  std::condition_variable posted_;
  std::deque<Task> tasks_;
};

}  // namespace fleetmap::testing
