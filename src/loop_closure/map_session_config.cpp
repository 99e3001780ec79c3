#include "fleetmap/loop_closure/map_session_config.hpp"

namespace fleetmap::loop_closure {

Status MapSessionConfig::validate() const {
  if (Status valid = candidates.validate(); !valid) return valid;
  if (Status valid = spherize.validate(); !valid) return valid;
  return registration.validate();
}

}  // namespace fleetmap::loop_closure
