#pragma once

#include <fastdds/rtps/attributes/RTPSParticipantAttributes.h>

#include <memory>

#include "radio_guard.hpp"

namespace fleetmap::bus {

/// Seals the transports of a participant and sets its prefix to the guard's session, so that no byte of a
/// stranger reaches Fast DDS.
void seal_transports(eprosima::fastrtps::rtps::RTPSParticipantAttributes& attributes,
                     const std::shared_ptr<RadioGuard>& guard);

}  // namespace fleetmap::bus
