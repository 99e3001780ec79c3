#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace fleetmap::apps {

/// An operator's order, as the command line has it.
struct OrderOptions {
  std::string config;            ///< AGENT.yaml of any robot, or FLEET.yaml
  std::string robot;             ///< empty: all
  std::string to;                ///< of a row: the robot that is to drive it; empty: any other one
  std::uint32_t row = 0;         ///< id
  double timeout = 15.0;         ///< s, to wait until every robot has confirmed
  std::vector<std::string> set;  ///< key=value
};

}  // namespace fleetmap::apps
