#include "fleetmap/agent/perception_config.hpp"

#include "fleetmap/ros_codec/topics.hpp"

namespace fleetmap::agent {

SensorTopics::SensorTopics()
    : points(ros_codec::topics::points().name),
      imu(ros_codec::topics::imu().name),
      fix(ros_codec::topics::fix().name),
      wheel(ros_codec::topics::wheel_odometry().name) {}

}  // namespace fleetmap::agent
