#pragma once

#include <string>

namespace fleetmap::testing {

/// "r1" of 1.
inline std::string robot_name(int robot) { return std::string("r").append(std::to_string(robot)); }

}  // namespace fleetmap::testing
