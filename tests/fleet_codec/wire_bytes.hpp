#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/fleet_codec/messages.hpp"

namespace fleetmap::fleet_codec::testing {

/// XCDR1, little-endian, member by member, as the OMG's specification (formal/2018-01-01) has it: each number
/// is aligned to its size, counted from behind the encapsulation header.
class WireBytes {
 public:
  template <class T>
  WireBytes& number(T value) {
    while ((bytes_.size() - kHeader) % sizeof(T) != 0) bytes_.push_back(0);
    const auto raw = std::bit_cast<std::array<std::uint8_t, sizeof(T)>>(value);
    bytes_.insert(bytes_.end(), raw.begin(), raw.end());
    return *this;
  }
  WireBytes& octet(std::uint8_t value) { return number(value); }
  /// Also the length of a sequence.
  WireBytes& u32(std::uint32_t value) { return number(value); }
  WireBytes& f32(float value) { return number(value); }
  WireBytes& f64(double value) { return number(value); }
  /// The name of an agent, padded with zeros to 8 octets.
  WireBytes& name(std::string_view text) {
    for (std::size_t k = 0; k < 8; ++k) octet(k < text.size() ? static_cast<std::uint8_t>(text[k]) : 0);
    return *this;
  }
  WireBytes& octets(std::size_t count, std::uint8_t value) {
    bytes_.insert(bytes_.end(), count, value);
    return *this;
  }
  template <class T, std::size_t kSize>
  WireBytes& numbers(const std::array<T, kSize>& values) {
    for (const T value : values) number(value);
    return *this;
  }
  const Bytes& bytes() const { return bytes_; }

 private:
  static constexpr std::size_t kHeader = 4;
  Bytes bytes_{0, 1, 0, 0};
};

/// Why a message that was encoded is not decoded; "none" if it is.
template <class T>
std::string refusal(const T& message) {
  const auto decoded = decode<T>(encode(message));
  return decoded ? "none" : decoded.error().message;
}

}  // namespace fleetmap::fleet_codec::testing
