#pragma once

#include <cstdint>
#include <string>

namespace fleetmap::apps {

/// The fleet's keys and one of its members, as the command line has them.
struct KeysOptions {
  std::string folder;  ///< of the operator
  std::string name;    ///< of the robot
  std::string role = "robot";
  std::uint32_t days = 365;  ///< that its keys are valid
};

}  // namespace fleetmap::apps
