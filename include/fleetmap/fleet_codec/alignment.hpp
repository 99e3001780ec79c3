#pragma once

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/fleet_codec/decode.hpp"
#include "fleetmap/graph/alignment.hpp"

namespace fleetmap::fleet_codec {

/// The alignment is rounded to what fits on the wire (see the IDL for the steps).
Bytes encode(const graph::Alignment& alignment);
template <>
Result<graph::Alignment> decode(ByteView cdr);

/// Likewise as signed_bytes() of a node (node.hpp).
Bytes signed_bytes(const graph::Alignment& alignment);

/// Likewise as quantised() of a node (node.hpp). The first Alignment::kMaxModes modes are kept.
Result<graph::Alignment> quantised(const graph::Alignment& alignment);

}  // namespace fleetmap::fleet_codec
