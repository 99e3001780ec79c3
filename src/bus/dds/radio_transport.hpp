#pragma once

#include <fastdds/rtps/attributes/RTPSParticipantAttributes.h>

#include <memory>

#include "radio_guard.hpp"

namespace fleetmap::bus {

/// Strips what Fast DDS's statistics append from all that the participant sends. With a guard it is
/// sealed, the participant's prefix is the guard's session, and no byte of a stranger reaches Fast DDS. Null
/// without keys.
void prepare_transports(eprosima::fastrtps::rtps::RTPSParticipantAttributes& attributes,
                        const std::shared_ptr<RadioGuard>& guard);

}  // namespace fleetmap::bus
