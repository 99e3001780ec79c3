#pragma once

/// Names of ROS 2's types as DDS announces them.
namespace fleetmap::ros_codec::type_name {

inline constexpr char kPointCloud2[] = "sensor_msgs::msg::dds_::PointCloud2_";
inline constexpr char kImu[] = "sensor_msgs::msg::dds_::Imu_";
inline constexpr char kNavSatFix[] = "sensor_msgs::msg::dds_::NavSatFix_";
inline constexpr char kOdometry[] = "nav_msgs::msg::dds_::Odometry_";
inline constexpr char kBatteryState[] = "sensor_msgs::msg::dds_::BatteryState_";
inline constexpr char kTwist[] = "geometry_msgs::msg::dds_::Twist_";
inline constexpr char kTfMessage[] = "tf2_msgs::msg::dds_::TFMessage_";
inline constexpr char kPoseStamped[] = "geometry_msgs::msg::dds_::PoseWithCovarianceStamped_";
inline constexpr char kPath[] = "nav_msgs::msg::dds_::Path_";
inline constexpr char kDiagnostics[] = "diagnostic_msgs::msg::dds_::DiagnosticArray_";
inline constexpr char kMarkers[] = "visualization_msgs::msg::dds_::MarkerArray_";
inline constexpr char kLivoxDriver2[] = "livox_ros_driver2::msg::dds_::CustomMsg_";
inline constexpr char kLivoxDriver[] = "livox_ros_driver::msg::dds_::CustomMsg_";
inline constexpr char kLivoxInterfaces[] = "livox_interfaces::msg::dds_::CustomMsg_";
inline constexpr char kVelodyneScan[] = "velodyne_msgs::msg::dds_::VelodyneScan_";

}  // namespace fleetmap::ros_codec::type_name
