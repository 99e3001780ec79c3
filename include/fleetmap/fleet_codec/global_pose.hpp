#pragma once

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/fleet_codec/decode.hpp"
#include "fleetmap/geometry/global_pose.hpp"

namespace fleetmap::fleet_codec {

Bytes encode(const GlobalPose& pose);
template <>
Result<GlobalPose> decode(ByteView cdr);

}  // namespace fleetmap::fleet_codec
