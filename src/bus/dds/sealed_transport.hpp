#pragma once

#include <fastdds/rtps/attributes/RTPSParticipantAttributes.h>

#include <memory>

#include "radio_guard.hpp"

namespace fleetmap::bus {

/// Puts a seal on the transports of a participant, and gives it the guard's session as prefix: no byte of who
/// is no member reaches Fast DDS.
void seal_transports(eprosima::fastrtps::rtps::RTPSParticipantAttributes& attributes,
                     const std::shared_ptr<RadioGuard>& guard);

}  // namespace fleetmap::bus
