#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

#include "fleetmap/bus/dds_bus.hpp"

namespace fleetmap::apps {

/// Stops the robot when the bus's callback thread cannot: publishes zero velocity from a thread of its own,
/// every 20 ms, while no callback of the bus has run for 200 ms (a slow disk, a long computation) and from
/// the moment that `stop` is set until the end of the process, however long the maps take to be written.
class DriveWatchdog {
 public:
  /// `bus` and `stop` must outlive this. To be constructed and destroyed while no thread runs the bus.
  DriveWatchdog(bus::DdsBus& bus, const std::atomic<bool>& stop);
  /// From now on publishes zero, as if `stop` were set.
  void stop_driving() { driving_stopped_ = true; }

 private:
  void run(const std::stop_token& end);
  /// The callback thread did not come by for too long.
  bool stalled() const;

  bus::DdsBus& bus_;
  const std::atomic<bool>& stop_;
  std::atomic<bool> driving_stopped_ = false;
  std::atomic<std::int64_t> last_beat_;  ///< ns of the steady clock
  bus::Handle beat_;
  std::jthread thread_;
};

}  // namespace fleetmap::apps
