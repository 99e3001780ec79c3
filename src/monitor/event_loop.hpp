#pragma once

#include <chrono>
#include <functional>

namespace fleetmap::monitor {

/// A thread that runs tasks one after the other.
class EventLoop {
 public:
  using Clock = std::chrono::steady_clock;
  using Task = std::function<void()>;

  virtual ~EventLoop() = default;
  /// Runs `task` after those that wait already. Any thread may call it.
  virtual void post(Task task) = 0;
  /// Runs `task` at that time or soon after. Only the loop's own thread calls it.
  virtual void post_at(Clock::time_point time, Task task) = 0;
};

}  // namespace fleetmap::monitor
