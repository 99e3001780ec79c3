#pragma once

#include <optional>
#include <vector>

#include "comparison.hpp"
#include "fleetmap/registration/map_drift.hpp"
#include "fleetmap/registration/prior.hpp"

namespace fleetmap::registration {

struct FoundMode {
  Pose T_level = Pose::Identity();  ///< source's levelled frame into the target's
  IcpResult icp;
  Fit fit;
  double log_prior = 0.0;
  double weight = 0.0;
};

/// Every pose at which the clouds fit, within the prior, most weight first.
std::vector<FoundMode> find_modes(const PreparedCloud::Data& target, const PreparedCloud::Data& source,
                                  const RegistrationConfig& config, const std::optional<Prior>& prior,
                                  const Drifts& drifts);

}  // namespace fleetmap::registration
