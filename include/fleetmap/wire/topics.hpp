#pragma once

#include <vector>

#include "fleetmap/bus/bus.hpp"
#include "fleetmap/core/ids.hpp"
#include "fleetmap/exchange/messages.hpp"

/// Every topic of the system: link, name and type on the wire, and the QoS profile in qos/<link>.xml.
namespace fleetmap::wire::topics {

// ---- onboard: sensors and state of one robot, ROS 2 names where ROS 2 has the type
bus::Topic points();          ///< sensor::Scan
bus::Topic imu();             ///< sensor::Imu
bus::Topic fix();             ///< sensor::Fix
bus::Topic wheel_odometry();  ///< sensor::Wheel
bus::Topic odometry();        ///< wire::OdometryMsg
bus::Topic global_pose();     ///< GlobalPose
bus::Topic corrected_pose();  ///< GlobalPose: T_enu_odom of the fleet's graph, applied to the odometry
/// GlobalPose, from whoever else knows where the robot is: the mission is driven by it instead of by G.
bus::Topic guide_pose();
bus::Topic cmd_vel();  ///< wire::VelocityCommand
bus::Topic battery();  ///< sensor::Battery
/// exchange::Hold, from a button on the robot.
bus::Topic hold_onboard();

// ---- long range: to all
bus::Topic node();
bus::Topic alignment();
bus::Topic digest();
bus::Topic status();
bus::Topic mission_report();
bus::Topic hold();
// ---- long range: to one
bus::Topic proximity_match(const AgentId& recipient);
bus::Topic cloud_request(const AgentId& recipient);
bus::Topic item_request(const AgentId& recipient);
bus::Topic cloud_fragment(const AgentId& recipient);
// ---- short range
bus::Topic submap_digest();
bus::Topic submap_request(const AgentId& recipient);
bus::Topic submap_chunk(const AgentId& recipient);

}  // namespace fleetmap::wire::topics

namespace fleetmap::wire {

/// Where `message` is published: a topic of its recipient if it has one, else that of all.
bus::Topic topic_of(const exchange::Message& message);

/// All topics on which messages for `self` arrive from other agents.
std::vector<bus::Topic> inbox_topics(const AgentId& self);

}  // namespace fleetmap::wire
