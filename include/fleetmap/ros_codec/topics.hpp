#pragma once

#include "fleetmap/bus/bus.hpp"

/// Topics of one robot whose types are ROS 2's, under ROS 2's names; QoS profiles in qos/onboard.xml.
namespace fleetmap::ros_codec::topics {

bus::Topic points();          ///< sensor::Scan
bus::Topic imu();             ///< sensor::Imu
bus::Topic fix();             ///< sensor::Fix
bus::Topic wheel_odometry();  ///< sensor::Wheel
bus::Topic tf_static();       ///< std::vector<sensor::FrameTransform>
bus::Topic battery();         ///< sensor::Battery
bus::Topic odometry();        ///< OdometryMsg
bus::Topic cmd_vel();         ///< VelocityCommand

}  // namespace fleetmap::ros_codec::topics
