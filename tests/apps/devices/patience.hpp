#pragma once

#include <chrono>

namespace fleetmap::apps {

/// After which a test that waits for a device or its samples fails.
inline constexpr std::chrono::seconds kPatience(60);

}  // namespace fleetmap::apps
