#pragma once

#include <memory>
#include <mutex>
#include <utility>

namespace fleetmap::monitor {

/// The newest value on its way to another thread: one that was not taken yet is replaced. The lock is held
/// for the exchange of two pointers alone, so the thread that puts waits for nobody.
template <class T>
class LatestSlot {
 public:
  /// True if the slot was empty, so the taker has to be told.
  bool put(std::shared_ptr<const T> value) {
    {
      const std::scoped_lock lock(mutex_);
      std::swap(value_, value);
    }
    return value == nullptr;  // the value replaced is freed here, outside of the lock
  }
  /// Null if nothing was put since the last time.
  std::shared_ptr<const T> take() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(value_, nullptr);
  }

 private:
  std::mutex mutex_;  ///< of `value_`
  std::shared_ptr<const T> value_;
};

}  // namespace fleetmap::monitor
