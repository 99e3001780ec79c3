#pragma once

#include <initializer_list>

#include "fleetmap/core/bytes.hpp"

namespace fleetmap::trust {

/// One after the other.
Bytes joined(std::initializer_list<ByteView> parts);

}  // namespace fleetmap::trust
