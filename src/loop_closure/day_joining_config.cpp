#include "fleetmap/loop_closure/day_joining_config.hpp"

namespace fleetmap::loop_closure {

Status DayJoiningConfig::validate() const {
  if (Status valid = candidates.validate(); !valid) return valid;
  if (Status valid = spherize.validate(); !valid) return valid;
  return registration.validate();
}

}  // namespace fleetmap::loop_closure
