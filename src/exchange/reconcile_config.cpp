#include "fleetmap/exchange/reconcile_config.hpp"

namespace fleetmap::exchange {

Status ReconcileConfig::validate() const {
  if (digest_min_period <= Duration::zero() || digest_max_period < digest_min_period) {
    return failure("reconcile.digest_min_period must be positive and at most digest_max_period");
  }
  if (grace < Duration::zero()) return failure("reconcile.grace must not be negative");
  if (near_period <= Duration::zero() || store_pause <= Duration::zero() || max_store_pause < store_pause) {
    return failure(
        "reconcile.near_period and store_pause must be positive, max_store_pause at least store_pause");
  }
  if (timeout <= Duration::zero() || peer_timeout <= Duration::zero()) {
    return failure("reconcile.timeout and peer_timeout must be positive");
  }
  if (max_ranges == 0 || max_ranges > 256) return failure("reconcile.max_ranges must be in 1 .. 256");
  if (max_items == 0 || max_barren < 1)
    return failure("reconcile.max_items and max_barren must be at least 1");
  return {};
}

}  // namespace fleetmap::exchange
