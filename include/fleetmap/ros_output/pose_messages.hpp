#pragma once

#include <optional>
#include <vector>

#include "fleetmap/graph/pose_now.hpp"
#include "fleetmap/ros_codec/poses.hpp"
#include "fleetmap/sensor/samples.hpp"

/// ROS 2's view of a robot. Frames are those of REP 105: `map` is ENU at the site's origin, x to the east,
/// `odom` is smooth and drifts, `base_link` is the robot.
namespace fleetmap::ros_output {

inline constexpr char kMapFrame[] = "map", kOdomFrame[] = "odom", kBaseFrame[] = "base_link";

/// The robot on the map.
struct MapPose {
  GeoPoint origin;  ///< of the map
  Pose T_map_odom = Pose::Identity(), T_map_base = Pose::Identity();
  Matrix6d covariance = Matrix6d::Zero();  ///< of T_map_base, [m, rad] in the axes of the map
  bool georeferenced = false;              ///< else the map lies nowhere on Earth
};
/// By the fleet's graph; where that has not placed the odometry's frame yet, by G, if the origin is given.
std::optional<MapPose> map_pose(const graph::PoseNow& pose, const std::optional<GeoPoint>& origin);

/// odom to base_link and, on a map, map to odom. Both have the stamp of the scan.
std::vector<ros_codec::StampedTransform> transforms(const graph::PoseNow& pose,
                                                    const std::optional<MapPose>& on_map);
ros_codec::PoseMsg pose_message(const graph::PoseNow& pose, const MapPose& on_map);
/// WGS84 of base_link with its covariance along ENU there: by the map, else by G. Empty without both.
std::optional<sensor::Fix> fused_fix(const graph::PoseNow& pose, const std::optional<MapPose>& on_map);

}  // namespace fleetmap::ros_output
