#pragma once

#include <string>

#include "fleetmap/recording/bag_format.hpp"

namespace fleetmap::recording {

/// The profile of a topic's publisher, reliable with the last 10 messages kept, as the YAML text that rosbag2
/// of Humble writes into offered_qos_profiles and `ros2 bag play` offers.
std::string offered_qos(Durability durability);

}  // namespace fleetmap::recording
