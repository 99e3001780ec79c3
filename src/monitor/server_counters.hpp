#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace fleetmap::monitor {

/// Counters of a server that any thread may read (ServerStats).
struct ServerCounters {
  std::atomic<std::uint64_t> requests{0}, refused{0}, cut{0};
  std::atomic<std::size_t> connections{0}, viewers{0};  ///< now
};

}  // namespace fleetmap::monitor
