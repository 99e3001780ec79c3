#pragma once

#include <cstdint>

#include "fleetmap/monitor/server.hpp"

namespace fleetmap::testing {

/// A page of one file.
inline constexpr std::uint8_t kFile[] = {1, 2, 3};
inline constexpr monitor::PageFile kPage[] = {{"/index.html", "text/html", kFile}};

}  // namespace fleetmap::testing
