#pragma once

#include <unistd.h>

#include <cstdint>

namespace fleetmap::bus::testing {

/// First of four DDS domains for this process: tests that run at the same time have neighbouring process ids,
/// and so different domains. They stay below 100, where the ports are below those that the kernel hands out.
inline std::uint32_t first_test_domain() { return 2 + 4 * (static_cast<std::uint32_t>(getpid()) % 24); }

}  // namespace fleetmap::bus::testing
