#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <type_traits>

#include "fleetmap/core/bytes.hpp"

namespace fleetmap::monitor::foxglove {

static_assert(std::endian::native == std::endian::little, "numbers are written as they lie in memory");

/// Writes plain CDR (XCDR1) in little-endian with its encapsulation header, as Foxglove reads messages of
/// encoding "cdr" by a schema in OMG IDL. Members are written one after the other, in the schema's order.
class CdrWriter {
 public:
  /// Aligned to its size, counted from the end of the encapsulation header.
  template <class T>
  void number(T value) {
    static_assert(std::is_arithmetic_v<T> && !std::is_same_v<T, bool>);
    const std::size_t beyond = (bytes_.size() - kHeaderBytes) % sizeof value;
    const std::size_t at = bytes_.size() + (beyond == 0 ? 0 : sizeof value - beyond);
    bytes_.resize(at + sizeof value);
    std::memcpy(bytes_.data() + at, &value, sizeof value);
  }
  void flag(bool value) { bytes_.push_back(value ? 1 : 0); }
  template <class Enum>
  void enumerator(Enum value) {
    number(static_cast<std::uint32_t>(value));
  }
  /// Length of a sequence, whose elements follow.
  void count(std::size_t elements) { number(static_cast<std::uint32_t>(elements)); }
  void text(std::string_view value) {
    count(value.size() + 1);
    bytes_.insert(bytes_.end(), value.begin(), value.end());
    bytes_.push_back(0);
  }
  /// A sequence<uint8>.
  void octets(ByteView value) {
    count(value.size());
    bytes_.insert(bytes_.end(), value.begin(), value.end());
  }
  Bytes message() && { return std::move(bytes_); }

 private:
  static constexpr std::size_t kHeaderBytes = 4;
  Bytes bytes_{0x00, 0x01, 0x00, 0x00};  ///< CDR_LE, no options
};

}  // namespace fleetmap::monitor::foxglove
