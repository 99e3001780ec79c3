#pragma once

#include <string>

#include "fleetmap/graph/node.hpp"

namespace fleetmap::graph {

/// "r1", or "r1#4711" of session 4711.
std::string to_string(const FrameId& frame);

}  // namespace fleetmap::graph
