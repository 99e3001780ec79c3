#pragma once

#include <array>
#include <cstdint>

namespace fleetmap::sim {

/// A triangle of a mesh by the indices of its corners.
using Triangle = std::array<std::uint32_t, 3>;

}  // namespace fleetmap::sim
