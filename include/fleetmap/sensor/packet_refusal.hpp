#pragma once

#include <cstdint>
#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace fleetmap::sensor {

/// Cause for which a packet is refused.
enum class PacketFault : std::uint8_t {
  kSize,    ///< no packet of the device has so many bytes
  kBlock,   ///< a part that contradicts the format or the packets before
  kDevice,  ///< of a device or mode that is not decoded
};

/// Why a packet of a LiDAR is refused.
struct PacketRefusal {
  PacketFault fault = PacketFault::kSize;
  std::string what;  ///< with the value that was found
};

inline tl::unexpected<PacketRefusal> refused_packet(PacketFault fault, std::string what) {
  return tl::unexpected(PacketRefusal{fault, std::move(what)});
}

}  // namespace fleetmap::sensor
