#pragma once

/// Names of the IDL types as DDS announces them.
namespace fleetmap::fleet_codec::type_name {

inline constexpr char kGlobalPose[] = "fleetmap::msg::GlobalPose";
inline constexpr char kNode[] = "fleetmap::msg::Node";
inline constexpr char kAlignment[] = "fleetmap::msg::Alignment";
inline constexpr char kProximityMatch[] = "fleetmap::msg::ProximityMatch";
inline constexpr char kSpherizedCloud[] = "fleetmap::msg::SpherizedCloud";
inline constexpr char kCloudFragment[] = "fleetmap::msg::CloudFragment";
inline constexpr char kCloudRequest[] = "fleetmap::msg::CloudRequest";
inline constexpr char kDigest[] = "fleetmap::msg::Digest";
inline constexpr char kItemRequest[] = "fleetmap::msg::ItemRequest";
inline constexpr char kAgentStatus[] = "fleetmap::msg::AgentStatus";
inline constexpr char kMissionReport[] = "fleetmap::msg::MissionReport";
inline constexpr char kHold[] = "fleetmap::msg::Hold";
inline constexpr char kSubmapDigest[] = "fleetmap::msg::SubmapDigest";
inline constexpr char kSubmapRequest[] = "fleetmap::msg::SubmapRequest";
inline constexpr char kSubmapChunk[] = "fleetmap::msg::SubmapChunk";

}  // namespace fleetmap::fleet_codec::type_name
