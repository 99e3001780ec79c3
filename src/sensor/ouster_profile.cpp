#include "fleetmap/sensor/ouster_profile.hpp"

#include <array>

#include "fleetmap/core/byte_fields.hpp"
#include "fleetmap/core/text_list.hpp"

namespace fleetmap::sensor {
namespace {

/// All but the legacy format have a header and a footer around the packet, and the status of a column in
/// front.
constexpr OusterProfile with_header(std::string_view name, std::size_t pixel) {
  OusterProfile profile;
  profile.name = name;
  profile.packet_header = profile.packet_footer = 32;
  profile.column_header = 12;
  profile.column_footer = 0;
  profile.pixel = pixel;
  return profile;
}

constexpr OusterProfile fine(std::string_view name, std::size_t pixel, bool dual) {
  OusterProfile profile = with_header(name, pixel);
  profile.range_bits = 19;
  profile.reflectivity_at = dual ? 3 : 4;
  if (dual) profile.second_return = 4;
  return profile;
}

constexpr OusterProfile low_rate(std::string_view name, std::size_t pixel, bool dual) {
  OusterProfile profile = with_header(name, pixel);
  profile.range_bits = 15;
  profile.range_shift = 3;  // 8 mm
  profile.reflectivity_at = 2;
  if (dual) profile.second_return = 4;
  return profile;
}

constexpr OusterProfile functional_safety(std::string_view name) {
  OusterProfile profile = low_rate(name, 8, true);
  profile.wide_frame_id = true;
  return profile;
}

constexpr std::array kProfiles{OusterProfile{},
                               fine("RNG19_RFL8_SIG16_NIR16", 12, false),
                               fine("RNG19_RFL8_SIG16_NIR16_DUAL", 16, true),
                               low_rate("RNG15_RFL8_NIR8", 4, false),
                               low_rate("RNG15_RFL8_NIR8_DUAL", 8, true),
                               functional_safety("FUSA_RNG15_RFL8_NIR8_DUAL")};

OusterReturn return_at(const OusterProfile& profile, ByteView bytes) {
  const auto octet = [&](std::size_t at) { return std::uint32_t{bytes[at]} << (8 * at); };
  const std::uint32_t word = octet(0) | octet(1) | (profile.range_bits > 16 ? octet(2) : 0);
  const std::uint32_t mask = (1u << profile.range_bits) - 1;
  return {(word & mask) << profile.range_shift, bytes[profile.reflectivity_at]};
}

}  // namespace

OusterReturn OusterProfile::last_return(ByteView pixel_bytes) const {
  const OusterReturn first = return_at(*this, pixel_bytes);
  if (!second_return) return first;
  const OusterReturn second = return_at(*this, pixel_bytes.subspan(*second_return));
  return second.range > first.range ? second : first;
}

std::optional<OusterProfile> ouster_profile(std::string_view name) {
  for (const OusterProfile& profile : kProfiles) {
    if (profile.name == name) return profile;
  }
  return std::nullopt;
}

std::string ouster_profile_names() {
  std::string names;
  for (const OusterProfile& profile : kProfiles) append_to_list(names, std::string(profile.name));
  return names;
}

}  // namespace fleetmap::sensor
