#pragma once

#include <vector>

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

// Output alone.
bus::Topic tf();           ///< std::vector<StampedTransform>
bus::Topic pose();         ///< PoseMsg
bus::Topic fused_fix();    ///< sensor::Fix
bus::Topic path();         ///< PathMsg
bus::Topic diagnostics();  ///< DiagnosticsMsg
bus::Topic markers();      ///< MarkersMsg
bus::Topic submaps();      ///< MapPoints, of one submap each
bus::Topic map();          ///< MapPoints, of the whole map

/// All that a robot publishes for ROS 2's tools, with the odometry and /tf_static.
std::vector<bus::Topic> outputs();

}  // namespace fleetmap::ros_codec::topics
