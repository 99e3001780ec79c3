#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"

namespace fleetmap::exchange {

/// Order in which several clouds are requested and sent over the radio.
enum class CloudOrder : std::uint8_t {
  kInformation,  ///< that with the most information, as its receiver expects
  kFirstCome,    ///< that which was requested first
};

/// Configuration of CloudSender and CloudReceiver.
struct CloudTransferConfig {
  std::uint32_t max_cloud_bytes = 25'600;        ///< B, 25,000 of payload and a header
  std::size_t max_kept = 16;                     ///< encoded own clouds kept for repeated requests
  Duration kept_for = std::chrono::seconds(60);  ///< an older cloud is made anew when it is requested
  std::size_t max_receiving = 8;                 ///< clouds received at once
  Duration first_timeout =
      std::chrono::seconds(6);  ///< s of silence until the request is repeated; the peer computes and queues
  Duration gap_timeout =
      std::chrono::seconds(2);  ///< s of silence within a cloud until its missing pieces are requested
  double backoff = 1.6;         ///< timeouts grow by this with every try that brought nothing
  Duration max_timeout = std::chrono::seconds(30);
  int max_tries = 8;  ///< requests in a row without an answer until the cloud counts as lost
  CloudOrder order = CloudOrder::kInformation;
  /// An own good alignment ends the transfer of our cloud to the peer, which stops as well when it hears of
  /// it (CandidateConfig::stop_when_peer_aligned).
  bool cancel_when_aligned = true;
  Status validate() const;
};

}  // namespace fleetmap::exchange
