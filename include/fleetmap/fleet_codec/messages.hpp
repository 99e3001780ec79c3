#pragma once

#include "fleetmap/bus/bus.hpp"
#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/fleet_codec/alignment.hpp"
#include "fleetmap/fleet_codec/bounds.hpp"
#include "fleetmap/fleet_codec/decode.hpp"
#include "fleetmap/fleet_codec/global_pose.hpp"
#include "fleetmap/fleet_codec/long_range.hpp"
#include "fleetmap/fleet_codec/node.hpp"
#include "fleetmap/fleet_codec/short_range.hpp"
#include "fleetmap/messages/messages.hpp"

/// The fleet's messages as bytes: a 4-byte encapsulation header, then XCDR1, little-endian, of the IDL types
/// in idl/. Decoding accepts both byte orders, never allocates much more than the bytes it is given, and
/// refuses, with a reason, whatever could not have been encoded here: another schema version, bad agent
/// names, non-finite or out-of-range numbers, pieces outside of their whole.
namespace fleetmap::fleet_codec {

Bytes encode(const messages::Message& message);
/// Decodes a message of the fleet that came in on `topic`, by the topic's type.
Result<messages::Message> decode_message(const bus::Topic& topic, ByteView cdr);

}  // namespace fleetmap::fleet_codec
