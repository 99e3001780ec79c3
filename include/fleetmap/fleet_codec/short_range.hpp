#pragma once

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/fleet_codec/decode.hpp"
#include "fleetmap/messages/messages.hpp"

namespace fleetmap::fleet_codec {

/// Messages of the short-range link. A SubmapDigest carries its first kMax... entries (bounds.hpp): the
/// sender offers later what is cut off.
Bytes encode(const messages::SubmapDigest& digest);
Bytes encode(const messages::SubmapRequest& request);
Bytes encode(const messages::SubmapChunk& chunk);

template <>
Result<messages::SubmapDigest> decode(ByteView cdr);
template <>
Result<messages::SubmapRequest> decode(ByteView cdr);
template <>
Result<messages::SubmapChunk> decode(ByteView cdr);

}  // namespace fleetmap::fleet_codec
