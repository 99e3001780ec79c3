#pragma once

#include <string_view>

#include "fleetmap/core/result.hpp"
#include "fleetmap/sim/mesh.hpp"

namespace fleetmap::sim {

/// Parses the whole content of a file. Errors begin with ":line: " or ": byte n: ", to be put behind the
/// file's name.
Result<Mesh> parse_obj(std::string_view content);

}  // namespace fleetmap::sim
