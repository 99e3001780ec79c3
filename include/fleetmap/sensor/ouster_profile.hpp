#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "fleetmap/core/bytes.hpp"

namespace fleetmap::sensor {

/// A return of one beam.
struct OusterReturn {
  std::uint32_t range = 0;  ///< mm from the origin of `lidar` along the beam and its offset; 0: none
  std::uint8_t reflectivity = 0;
};

/// The layout of a lidar packet (`udp_profile_lidar`), by the software user manual.
struct OusterProfile {
  std::string_view name = "LEGACY";
  std::size_t packet_header = 0, column_header = 16, column_footer = 4, packet_footer = 0;  ///< B
  std::size_t pixel = 12;                                                                   ///< B of a beam
  /// Bits of the range in the first word of a return, and the shift that makes it mm.
  int range_bits = 20, range_shift = 0;
  std::size_t reflectivity_at = 4;                ///< B behind the beginning of a return
  std::optional<std::size_t> second_return = {};  ///< B; both are alike
  bool wide_frame_id = false;                     ///< 32 bits, else 16

  bool is_legacy() const { return packet_header == 0; }
  std::size_t packet_bytes(std::size_t columns, std::size_t beams) const {
    return packet_header + columns * column_bytes(beams) + packet_footer;
  }
  std::size_t column_bytes(std::size_t beams) const { return column_header + beams * pixel + column_footer; }
  /// The farther one of dual returns, since dust, rain and leaves in front of a surface give the nearer one.
  OusterReturn last_return(ByteView pixel_bytes) const;
};

/// By name: LEGACY, RNG19_RFL8_SIG16_NIR16, RNG19_RFL8_SIG16_NIR16_DUAL, RNG15_RFL8_NIR8,
/// RNG15_RFL8_NIR8_DUAL, FUSA_RNG15_RFL8_NIR8_DUAL. Empty for any other.
std::optional<OusterProfile> ouster_profile(std::string_view name);
/// All of them, for texts.
std::string ouster_profile_names();

}  // namespace fleetmap::sensor
