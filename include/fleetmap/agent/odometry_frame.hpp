#pragma once

#include <cstdint>
#include <functional>

#include "fleetmap/odometry/loam_counters.hpp"

namespace fleetmap::agent {

/// Keeps two origins of the odometry out of one session, whose nodes are all of one odometry frame.
class OdometryFrame {
 public:
  /// Begins a session for this reason and calls begun(). False: the store could not.
  using Begin = std::function<bool(const char* why)>;

  /// True if an update of the odometry with these counters belongs to the running session. With a new origin
  /// a session is begun first; until it can begin, nothing may enter the frame of the session before.
  bool admits(const odometry::LoamCounters& counters, const Begin& begin) const;
  /// A session has begun.
  void begun(const odometry::LoamCounters& counters);

 private:
  std::uint64_t map_restarts_ = 0;  ///< before the running session
  std::uint64_t clock_resets_ = 0;  ///< likewise
};

}  // namespace fleetmap::agent
