#pragma once

#include <functional>
#include <vector>

#include "fleetmap/agent/agent.hpp"
#include "fleetmap/bus/bus.hpp"
#include "ros_publisher.hpp"

namespace fleetmap::apps {

/// All that a robot in virtual time would publish for ROS 2's tools, for a recording.
class OutputRecording {
 public:
  using Write = std::function<void(const bus::Topic& topic, const Bytes& cdr)>;
  /// Agent and bus outlive it.
  OutputRecording(agent::Agent& agent, bus::Bus& bus, const ros_output::RosOutputConfig& config, Write write);

 private:
  Write write_;
  RosPublisher publisher_;
  std::vector<bus::Handle> subscriptions_;
};

}  // namespace fleetmap::apps
