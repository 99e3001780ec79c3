#pragma once

#include "fleetmap/core/result.hpp"
#include "fleetmap/loop_closure/loop_closure_config.hpp"
#include "fleetmap/registration/registration_config.hpp"
#include "fleetmap/registration/spherize_config.hpp"

namespace fleetmap::loop_closure {

struct DayJoiningConfig {
  LoopClosureConfig candidates;  ///< of these `proximity`, `max_sigma_m`, `descriptors`, `spacing_m`
  registration::SpherizeConfig spherize;
  registration::RegistrationConfig registration;
  Status validate() const;
};

}  // namespace fleetmap::loop_closure
