#pragma once

#include "fleetmap/core/result.hpp"
#include "fleetmap/loop_closure/candidate_config.hpp"
#include "fleetmap/registration/registration_config.hpp"
#include "fleetmap/registration/spherize_config.hpp"

namespace fleetmap::loop_closure {

/// Candidates and registration of align_map_sessions().
struct MapSessionConfig {
  CandidateConfig candidates;  ///< of these `proximity`, `max_sigma_m`, `descriptors`, `spacing_m`
  registration::SpherizeConfig spherize;
  registration::RegistrationConfig registration;
  Status validate() const;
};

}  // namespace fleetmap::loop_closure
