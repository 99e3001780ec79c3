#pragma once

#include <array>
#include <cstdint>

namespace fleetmap::bus {

/// The three DDS domains of a robot.
enum class Link : std::uint8_t { kOnboard, kLongRange, kShortRange };

inline constexpr std::array kLinks = {Link::kOnboard, Link::kLongRange, Link::kShortRange};

const char* to_string(Link link);

}  // namespace fleetmap::bus
