#include "fleetmap/exchange/cloud_transfer_config.hpp"

#include <string>

#include "fleetmap/messages/messages.hpp"

namespace fleetmap::exchange {

using messages::CloudFragment;
using messages::CloudRequest;

namespace {

constexpr std::size_t kMaxCloudBytes = CloudFragment::kMaxPayload * CloudRequest::kMaxMissing;

}  // namespace

Status CloudTransferConfig::validate() const {
  if (max_cloud_bytes == 0 || max_cloud_bytes > kMaxCloudBytes) {
    return failure("cloud_transfer.max_cloud_bytes must be in 1 .. " + std::to_string(kMaxCloudBytes));
  }
  if (max_kept == 0 || max_receiving == 0) {
    return failure("cloud_transfer.max_kept and max_receiving must be at least 1");
  }
  if (first_timeout <= Duration::zero() || gap_timeout <= Duration::zero() ||
      max_timeout <= Duration::zero()) {
    return failure("cloud_transfer timeouts must be positive");
  }
  if (!(backoff >= 1.0) || backoff > 10.0) return failure("cloud_transfer.backoff must be in 1 .. 10");
  if (max_tries < 1) return failure("cloud_transfer.max_tries must be at least 1");
  return {};
}

}  // namespace fleetmap::exchange
