#include "fleetmap/loop_closure/candidate_config.hpp"

namespace fleetmap::loop_closure {

Status CandidateConfig::validate() const {
  if (auto status = proximity.validate(); !status) return status;
  if (auto status = descriptors.validate(); !status) return status;
  if (!(max_sigma_m > 0.0)) return failure("loop_candidates.max_sigma_m must be positive");
  if (!(spacing_m >= 0.0) || !(spacing_aligned_m >= 0.0) || !(spacing_failed_m >= 0.0)) {
    return failure("loop_candidates.spacing, spacing_aligned and spacing_failed must not be negative");
  }
  if (max_wait < Duration::zero() || retry_after < Duration::zero()) {
    return failure("loop_candidates.max_wait and retry_after must not be negative");
  }
  if (max_attempts < 1 || max_active == 0 || max_waiting == 0) {
    return failure("loop_candidates.max_attempts, max_active and max_waiting must be at least 1");
  }
  if (!(min_information >= 0.0)) return failure("loop_candidates.min_information must not be negative");
  if (peer_timeout <= Duration::zero() || match_period <= Duration::zero() || match_repeats < 0) {
    return failure(
        "loop_candidates.peer_timeout and match_period must be positive, match_repeats not negative");
  }
  return {};
}

}  // namespace fleetmap::loop_closure
