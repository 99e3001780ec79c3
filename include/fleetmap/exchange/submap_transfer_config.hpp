#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/exchange/delay_window_config.hpp"

namespace fleetmap::exchange {

/// Configuration of SubmapSender and SubmapReceiver.
struct SubmapTransferConfig {
  double bytes_per_second = 1'875'000;   ///< B/s that this agent sends at most: a link of 15 Mbit/s
  double burst_bytes = 131'072;          ///< B; at least bytes_per_second times the time between two ticks
  std::size_t overhead_bytes = 360;      ///< B a chunk: headers of its three datagrams of two IP packets each
  DelayWindowConfig window;              ///< B requested and not yet received, of one peer and of all
  std::uint32_t request_bytes = 65'536;  ///< B requested by one message at most
  Duration digest_period = std::chrono::seconds(1);
  Duration peer_timeout = std::chrono::seconds(4);        ///< s, a peer not heard for so long is out of reach
  Duration min_timeout = std::chrono::milliseconds(300);  ///< of a chunk; the measured delay raises it
  Duration max_timeout = std::chrono::seconds(3);
  /// A peer that sent wrong content of a submap is not asked for it for so long, doubled at each repetition.
  Duration first_distrust = std::chrono::seconds(10);
  Duration max_distrust = std::chrono::minutes(5);
  Duration store_pause = std::chrono::seconds(5);  ///< no requests after the store failed (disk full)
  std::size_t max_ranges = 64;                     ///< in a digest
  std::size_t max_queued_chunks =
      256;  ///< waiting for one peer; further requests are dropped and will be repeated
  Status validate() const;
};

}  // namespace fleetmap::exchange
