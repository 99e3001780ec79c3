#pragma once

#include <cstddef>
#include <cstdint>

#include "fleetmap/bus/bus.hpp"
#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/global_pose.hpp"
#include "fleetmap/messages/messages.hpp"

/// The fleet's messages as bytes: a 4-byte encapsulation header, then XCDR1, little-endian, of the IDL types
/// in idl/. Decoding accepts both byte orders, never allocates much more than the bytes it is given, and
/// refuses, with a reason, whatever could not have been encoded here: another schema version, bad agent
/// names, non-finite or out-of-range numbers, pieces outside of their whole.
namespace fleetmap::fleet_codec {

/// First octet of every type of module fleetmap. Raised when a member changes.
inline constexpr std::uint8_t kSchemaVersion = 6;

// Bounds that the IDL and decoding share.
inline constexpr std::size_t kMaxCloudPayload = 25'000;  ///< bytes of a SpherizedCloud's payload
inline constexpr std::size_t kMaxRanges = 256;           ///< in a Digest or ItemRequest, per kind
inline constexpr std::size_t kMaxSubmapRanges = 1'024;   ///< in a SubmapDigest
inline constexpr std::size_t kMaxHeard = 255;            ///< agents in a SubmapDigest
inline constexpr std::size_t kMaxMissing = messages::CloudRequest::kMaxMissing;  ///< in a CloudRequest
inline constexpr std::size_t kMaxRowSet = 512;               ///< bytes of each set of rows in a MissionReport
inline constexpr std::size_t kMaxHoldOrders = 32;            ///< in a Hold
inline constexpr std::size_t kMaxLoans = 4;                  ///< in an AgentStatus
inline constexpr std::uint32_t kMaxSubmapBytes = 64u << 20;  ///< of one encoded submap

/// Bytes that encode() adds to the payload of a SpherizedCloud.
inline constexpr std::size_t kSpherizedCloudOverhead = 36;
/// Most bytes of an encoded cloud that CloudFragments can carry.
inline constexpr std::size_t kMaxEncodedCloud = kMaxCloudPayload + kSpherizedCloudOverhead;

/// Node and Alignment are rounded to what fits on the wire (see the IDL for the steps). Digest, ItemRequest,
/// CloudRequest, MissionReport, Hold and SubmapDigest carry their first kMax... entries: what is cut off is
/// offered or asked for again later. Payloads beyond the type's bound are a bug of the caller and are cut,
/// which their hash then shows.
Bytes encode(const graph::Node& node);
Bytes encode(const graph::Alignment& alignment);
Bytes encode(const messages::ProximityMatch& match);
Bytes encode(const messages::CloudFragment& fragment);
Bytes encode(const messages::CloudRequest& request);
Bytes encode(const messages::Digest& digest);
Bytes encode(const messages::ItemRequest& request);
Bytes encode(const messages::AgentStatus& status);
Bytes encode(const messages::MissionReport& report);
Bytes encode(const messages::Hold& hold);
Bytes encode(const messages::SubmapDigest& digest);
Bytes encode(const messages::SubmapRequest& request);
Bytes encode(const messages::SubmapChunk& chunk);
Bytes encode(const messages::Message& message);
Bytes encode(const GlobalPose& pose);
Bytes encode(const messages::SpherizedCloud& cloud);

/// The bytes that the maker of an item signs: its encoding with schema version 0 and without signature, so
/// that signatures stay valid if a new version does not change the type. decode() returns values whose
/// encoding is these bytes on every processor, and the store keeps them. decode() refuses a signed item that
/// differs from the encoding of its decoded value, so a signature is valid for one content only.
Bytes signed_bytes(const graph::Node& node);
Bytes signed_bytes(const graph::Alignment& alignment);

/// T is any type with an encode() above except messages::Message. Errors say which type and why.
template <class T>
Result<T> decode(ByteView cdr);

template <>
Result<graph::Node> decode(ByteView cdr);
template <>
Result<graph::Alignment> decode(ByteView cdr);
template <>
Result<messages::ProximityMatch> decode(ByteView cdr);
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
template <>
Result<messages::SubmapDigest> decode(ByteView cdr);
template <>
Result<messages::SubmapRequest> decode(ByteView cdr);
template <>
Result<messages::SubmapChunk> decode(ByteView cdr);
template <>
Result<GlobalPose> decode(ByteView cdr);
template <>
Result<messages::SpherizedCloud> decode(ByteView cdr);

/// Decodes a message of the fleet that came in on `topic`, by the topic's type.
Result<messages::Message> decode_message(const bus::Topic& topic, ByteView cdr);

/// The value that every receiver of `node` will hold. Its owner must keep this one too, so that the whole
/// fleet computes with the same numbers; rounding it again changes nothing. Of G's covariance remain the
/// position's variances and east-north covariance, the mean variance of the tilts, and the yaw's. An
/// odom_covariance that is none counts as unknown, and so is very large. A signature is left out. Fails when
/// `node` could not be decoded (non-finite pose, position off the Earth, ...).
Result<graph::Node> quantised(const graph::Node& node);
/// Likewise for an alignment. The first Alignment::kMaxModes modes are kept.
Result<graph::Alignment> quantised(const graph::Alignment& alignment);

}  // namespace fleetmap::fleet_codec
