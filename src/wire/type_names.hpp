#pragma once

/// Names of the IDL types as DDS announces them.
namespace fleetmap::wire::type_name {

inline constexpr char kPointCloud2[] = "sensor_msgs::msg::dds_::PointCloud2_";
inline constexpr char kImu[] = "sensor_msgs::msg::dds_::Imu_";
inline constexpr char kNavSatFix[] = "sensor_msgs::msg::dds_::NavSatFix_";
inline constexpr char kOdometry[] = "nav_msgs::msg::dds_::Odometry_";
inline constexpr char kBatteryState[] = "sensor_msgs::msg::dds_::BatteryState_";
inline constexpr char kTwist[] = "geometry_msgs::msg::dds_::Twist_";

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

}  // namespace fleetmap::wire::type_name
