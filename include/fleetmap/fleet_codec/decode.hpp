#pragma once

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::fleet_codec {

/// T is any type with an encode() in this folder except messages::Message. Errors name the type and the
/// cause.
template <class T>
Result<T> decode(ByteView cdr);

}  // namespace fleetmap::fleet_codec
