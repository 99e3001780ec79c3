#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"

namespace fleetmap::exchange {

/// Configuration of Reconcile.
struct ReconcileConfig {
  Duration digest_min_period = std::chrono::seconds(4);   ///< between digests while what is held changes
  Duration digest_max_period = std::chrono::seconds(30);  ///< doubles up to this while nothing changes
  Duration near_period = std::chrono::seconds(2);         ///< between digests over the short range
  Duration grace =
      std::chrono::milliseconds(500);  ///< an offered item that has not arrived after this time is requested
  Duration timeout =
      std::chrono::seconds(8);  ///< of a request without an answer; then another robot is asked
  Duration store_pause =
      std::chrono::seconds(10);  ///< no requests after the store failed, doubled at each failure
  Duration max_store_pause = std::chrono::minutes(2);
  Duration peer_timeout = std::chrono::seconds(90);  ///< a robot silent for so long gets no requests
  std::size_t max_ranges = 28;   ///< in each list of a digest or request, so that it fits one datagram
  std::uint32_t max_items = 48;  ///< per request
  int max_barren = 8;  ///< requests in a row that bring nothing until what an agent offers is not waited for
  Status validate() const;
};

}  // namespace fleetmap::exchange
