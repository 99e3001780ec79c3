#pragma once

#include <concepts>
#include <cstdint>
#include <string>

#include "fleetmap/core/bytes.hpp"

namespace fleetmap {

/// Takes little-endian fields off the front of bytes. After one that is not all there, all further ones are
/// zero or empty, and whole() is false.
class ByteFields {
 public:
  explicit ByteFields(ByteView bytes) : rest_(bytes) {}

  template <std::unsigned_integral T>
  T number() {
    const ByteView bytes = take(sizeof(T));
    T value = 0;
    for (std::size_t k = bytes.size(); k-- > 0;) value = static_cast<T>(value << 8 | bytes[k]);
    return value;
  }
  ByteView take(std::uint64_t count) {
    if (count > rest_.size()) {
      whole_ = false;
      rest_ = {};
      return {};
    }
    const ByteView bytes = rest_.first(count);
    rest_ = rest_.subspan(count);
    return bytes;
  }
  /// Bytes behind their number as uint32.
  ByteView counted() { return take(number<std::uint32_t>()); }
  std::string text() {
    const ByteView bytes = counted();
    return {bytes.begin(), bytes.end()};
  }
  ByteView rest() const { return rest_; }
  bool whole() const { return whole_; }

 private:
  ByteView rest_;
  bool whole_ = true;
};

}  // namespace fleetmap
