#pragma once

#include <cstdint>
#include <string>

#include "fleetmap/agent/failure_log.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::agent {

/// Logs when an agent's store fails and when it works again. A full or read-only disk refuses every item, so
/// not every failure is logged.
class StoreFailures {
 public:
  /// `agent` and `store` name the two in the log.
  StoreFailures(std::string agent, std::string store);

  /// `added`: StoreStats::added at this moment.
  void on_failure(const Error& error, std::uint64_t added, Stamp now);
  /// To be called periodically: the store works again once it has added an item.
  void check(std::uint64_t added);
  /// Writes that failed.
  std::uint64_t total() const { return log_.total(); }

 private:
  std::string agent_, store_;
  FailureLog log_;
  std::uint64_t added_before_failure_ = 0;
};

}  // namespace fleetmap::agent
