#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>

namespace fleetmap::testing {

/// Tests `condition` again until it holds; false after `patience`. For what shows only in the files of
/// another process, which notifies nobody.
inline bool eventually(const std::function<bool()>& condition, std::chrono::seconds patience) {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  std::mutex mutex;
  std::condition_variable never;
  std::unique_lock lock(mutex);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    never.wait_for(lock, std::chrono::milliseconds(50));
  }
  return true;
}

}  // namespace fleetmap::testing
