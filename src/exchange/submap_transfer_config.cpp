#include "fleetmap/exchange/submap_transfer_config.hpp"

#include <cmath>
#include <string>

#include "chunk_size.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::exchange {

Status SubmapTransferConfig::validate() const {
  if (!(bytes_per_second > 0.0) || !std::isfinite(bytes_per_second)) {
    return failure("submap_transfer.bytes_per_second must be positive");
  }
  if (!(burst_bytes >= kChunk) || !std::isfinite(burst_bytes)) {
    return failure("submap_transfer.burst_bytes must be at least " + std::to_string(kChunk));
  }
  if (auto status = window.validate(); !status) return status;
  if (window.min_bytes < kChunk || request_bytes < kChunk) {
    return failure("submap_transfer.window.min_bytes and request_bytes must be at least " +
                   std::to_string(kChunk));
  }
  if (first_distrust <= Duration::zero() || max_distrust < first_distrust ||
      store_pause <= Duration::zero()) {
    return failure(
        "submap_transfer.first_distrust and store_pause must be positive, max_distrust at least "
        "first_distrust");
  }
  if (digest_period <= Duration::zero() || peer_timeout <= digest_period) {
    return failure("submap_transfer.digest_period must be positive and less than peer_timeout");
  }
  if (min_timeout <= Duration::zero() || max_timeout < min_timeout) {
    return failure("submap_transfer.min_timeout must be positive and at most max_timeout");
  }
  if (max_ranges == 0 || max_ranges > 1024) return failure("submap_transfer.max_ranges must be in 1 .. 1024");
  if (max_queued_chunks == 0) return failure("submap_transfer.max_queued_chunks must be at least 1");
  return {};
}

}  // namespace fleetmap::exchange
