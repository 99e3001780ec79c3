#pragma once

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/fleet_codec/decode.hpp"
#include "fleetmap/messages/messages.hpp"

namespace fleetmap::fleet_codec {

/// Messages of the long-range link. Digest, ItemRequest, CloudRequest, MissionReport and Hold carry their
/// first kMax... entries (bounds.hpp): the sender offers or requests later what is cut off. A payload beyond
/// the type's bound is a bug of the caller and is cut, which its hash then shows.
Bytes encode(const messages::ProximityMatch& match);
Bytes encode(const messages::SpherizedCloud& cloud);
Bytes encode(const messages::CloudFragment& fragment);
Bytes encode(const messages::CloudRequest& request);
Bytes encode(const messages::Digest& digest);
Bytes encode(const messages::ItemRequest& request);
Bytes encode(const messages::AgentStatus& status);
Bytes encode(const messages::MissionReport& report);
Bytes encode(const messages::Hold& hold);

template <>
Result<messages::ProximityMatch> decode(ByteView cdr);
template <>
Result<messages::SpherizedCloud> decode(ByteView cdr);
template <>
Result<messages::CloudFragment> decode(ByteView cdr);
template <>
Result<messages::CloudRequest> decode(ByteView cdr);
template <>
Result<messages::Digest> decode(ByteView cdr);
template <>
Result<messages::ItemRequest> decode(ByteView cdr);
template <>
Result<messages::AgentStatus> decode(ByteView cdr);
template <>
Result<messages::MissionReport> decode(ByteView cdr);
template <>
Result<messages::Hold> decode(ByteView cdr);

}  // namespace fleetmap::fleet_codec
