#pragma once

#include <vector>

#include "fleetmap/bus/bus.hpp"
#include "fleetmap/core/ids.hpp"
#include "fleetmap/messages/routing.hpp"

/// Topics whose types are ours: link, name and type on the wire, and the QoS profile in qos/<link>.xml.
namespace fleetmap::fleet_codec::topics {

// ---- onboard; those of ROS 2's types are in ros_codec/topics.hpp
bus::Topic global_pose();     ///< GlobalPose
bus::Topic corrected_pose();  ///< GlobalPose: T_enu_odom of the fleet's graph, applied to the odometry
/// GlobalPose, from another localization of the robot: the navigator uses it instead of G.
bus::Topic guide_pose();
/// messages::Hold, from a button on the robot.
bus::Topic hold_onboard();

// ---- the fleet's radios. A topic that both radios carry has the same name on both.
/// Orders to stand still; operators publish here.
bus::Topic hold();

}  // namespace fleetmap::fleet_codec::topics

namespace fleetmap::fleet_codec {

/// The topic of a message: its recipient's if it has one, else the one that all read.
bus::Topic topic_of(const messages::Outgoing& outgoing);
/// The topic of a message on its usual link, to the recipient that it names.
bus::Topic topic_of(const messages::Message& message);
/// The link that `link` is to the exchange.
messages::Reach reach_of(bus::Link link);

/// All topics on which messages for `self` arrive from other agents.
std::vector<bus::Topic> inbox_topics(const AgentId& self);

}  // namespace fleetmap::fleet_codec
