#pragma once

#include <cstddef>
#include <cstdint>

#include "fleetmap/messages/messages.hpp"

namespace fleetmap::fleet_codec {

/// First octet of every type of module fleetmap. Raised when a member changes.
inline constexpr std::uint8_t kSchemaVersion = 7;

// Bounds that the IDL and decoding share.
inline constexpr std::size_t kMaxCloudPayload = 25'000;  ///< bytes of a SpherizedCloud's payload
inline constexpr std::size_t kMaxRanges = 256;           ///< in a Digest or ItemRequest, per kind
inline constexpr std::size_t kMaxSubmapRanges = 1'024;   ///< in a SubmapDigest
inline constexpr std::size_t kMaxHeard = 255;            ///< agents in a SubmapDigest
inline constexpr std::size_t kMaxMissing = messages::CloudRequest::kMaxMissing;  ///< in a CloudRequest
inline constexpr std::size_t kMaxRowSet = 512;     ///< bytes of each set of rows in a MissionReport
inline constexpr std::size_t kMaxHoldOrders = 32;  ///< in a Hold
inline constexpr std::size_t kMaxRowOrders = messages::Hold::kMaxRows;  ///< likewise
inline constexpr std::size_t kMaxLoans = 4;                             ///< in an AgentStatus
inline constexpr std::uint32_t kMaxSubmapBytes = 64u << 20;             ///< of one encoded submap

/// Bytes that encode() adds to the payload of a SpherizedCloud.
inline constexpr std::size_t kSpherizedCloudOverhead = 36;
/// Most bytes of an encoded cloud that CloudFragments can carry.
inline constexpr std::size_t kMaxEncodedCloud = kMaxCloudPayload + kSpherizedCloudOverhead;

}  // namespace fleetmap::fleet_codec
