#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <future>
#include <mutex>
#include <thread>
#include <vector>

namespace fleetmap {

/// Threads that take work in the order in which it was given.
class ThreadPool {
 public:
  /// Without threads, run() does the work itself before it returns.
  explicit ThreadPool(unsigned threads);
  /// Ends what was given, then the threads.
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  /// The future is ready when `work` has ended and holds what it threw.
  std::future<void> run(std::function<void()> work);

 private:
  void loop();

  std::mutex mutex_;  ///< guards work_ and ending_
  std::condition_variable changed_;
  std::deque<std::packaged_task<void()>> work_;
  bool ending_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace fleetmap
