#pragma once

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/fleet_codec/decode.hpp"
#include "fleetmap/graph/node.hpp"

namespace fleetmap::fleet_codec {

/// The node is rounded to what fits on the wire (see the IDL for the steps).
Bytes encode(const graph::Node& node);
template <>
Result<graph::Node> decode(ByteView cdr);

/// The bytes that the maker of an item signs: its encoding with schema version 0 and without signature, so
/// that signatures stay valid if a new version does not change the type. decode() returns values whose
/// encoding is these bytes on every processor, and the store keeps them. decode() refuses a signed item that
/// differs from the encoding of its decoded value, so a signature is valid for one content only.
Bytes signed_bytes(const graph::Node& node);

/// The value that every receiver of `node` will hold. Its owner must keep this one too, so that the whole
/// fleet computes with the same numbers; rounding it again changes nothing. G's covariance
/// keeps the position's variances and east-north covariance, the mean variance of the tilts, and the yaw's.
/// An odom_covariance that is none counts as unknown, and so is very large. A signature is left out. Fails
/// when `node` could not be decoded (non-finite pose, position off the Earth, ...).
Result<graph::Node> quantised(const graph::Node& node);

}  // namespace fleetmap::fleet_codec
