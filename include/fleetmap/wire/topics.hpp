#pragma once

#include <vector>

#include "fleetmap/bus/bus.hpp"
#include "fleetmap/core/ids.hpp"
#include "fleetmap/exchange/routing.hpp"

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

// ---- the fleet's radios. What goes over both has the same name on both.
/// Orders to stand still; operators publish here.
bus::Topic hold();

}  // namespace fleetmap::wire::topics

namespace fleetmap::wire {

/// Where a message is published: on a topic of its recipient if it has one, else on that of all.
bus::Topic topic_of(const exchange::Outgoing& outgoing);
/// On its usual link, to the recipient that it names.
bus::Topic topic_of(const exchange::Message& message);
/// The link that `link` is to the exchange.
exchange::Reach reach_of(bus::Link link);

/// All topics on which messages for `self` arrive from other agents.
std::vector<bus::Topic> inbox_topics(const AgentId& self);

}  // namespace fleetmap::wire
