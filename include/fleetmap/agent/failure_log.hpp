#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "fleetmap/core/time.hpp"

namespace fleetmap::agent {

/// Decides which failures of one thing, a disk, are worth a line: the first since it worked, and none for
/// `pause` after it. All are counted.
class FailureLog {
 public:
  explicit FailureLog(Duration pause) : pause_(pause) {}

  /// True when the failure is to be reported.
  bool on_failure(Stamp now) {
    ++total_;
    ++since_it_worked_;
    const bool recent = reported_ && now - *reported_ < pause_;
    if (std::exchange(failing_, true) || recent) return false;
    reported_ = now;
    return true;
  }

  /// Number of failures since it worked, once after failures of which one was reported.
  std::uint64_t on_success() {
    if (!std::exchange(failing_, false) || !reported_) return 0;
    return std::exchange(since_it_worked_, 0);
  }

  bool failing() const { return failing_; }
  std::uint64_t total() const { return total_; }

 private:
  Duration pause_;
  bool failing_ = false;
  std::optional<Stamp> reported_;
  std::uint64_t since_it_worked_ = 0;
  std::uint64_t total_ = 0;
};

}  // namespace fleetmap::agent
