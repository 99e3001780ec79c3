#pragma once

#include "fleetmap/core/ids.hpp"
#include "fleetmap/loop_closure/candidate_config.hpp"
#include "fleetmap/loop_closure/own_path_config.hpp"
#include "fleetmap/registration/registration_config.hpp"
#include "fleetmap/registration/spherize_config.hpp"

namespace fleetmap::loop_closure {

/// Candidates, spherization and registration of one robot's loop closing.
struct LoopClosingConfig {
  AgentId self;
  CandidateConfig candidates;  ///< with peers and earlier sessions
  OwnPathConfig own_path;
  bool closes_own_path = true;
  registration::SpherizeConfig spherize;
  registration::RegistrationConfig registration;
};

}  // namespace fleetmap::loop_closure
