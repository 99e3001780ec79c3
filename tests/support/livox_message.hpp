#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <string>
#include <vector>

#include "fleetmap/core/bytes.hpp"

namespace fleetmap::testing {

/// A CustomMsg of a Livox driver, serialised by its definition (CustomMsg.msg), without the program's codec.
struct LivoxMessage {
  struct Point {
    std::uint32_t offset_time = 0;  ///< ns
    float x = 1.0f, y = 2.0f, z = 3.0f;
    std::uint8_t reflectivity = 0, tag = 0, line = 0;
  };
  std::uint64_t stamp = 0, timebase = 0;  ///< ns
  std::string frame = "livox_frame";
  std::vector<Point> points{};

  Bytes ros1() const { return serialised(false); }
  /// CDR, little-endian.
  Bytes cdr() const { return serialised(true); }

 private:
  /// Fields one after the other, in CDR at a multiple of their size.
  class Writer {
   public:
    explicit Writer(bool aligns) : aligns_(aligns) {}
    template <std::unsigned_integral T>
    void put(T value) {
      while (aligns_ && bytes_.size() % sizeof(T) != 0) bytes_.push_back(0);
      for (std::size_t k = 0; k < sizeof(T); ++k)
        bytes_.push_back(static_cast<std::uint8_t>(value >> (8 * k)));
    }
    void put(float value) { put(std::bit_cast<std::uint32_t>(value)); }
    void put(const std::string& text) {
      put(static_cast<std::uint32_t>(text.size() + (aligns_ ? 1 : 0)));
      bytes_.insert(bytes_.end(), text.begin(), text.end());
      if (aligns_) bytes_.push_back(0);
    }
    const Bytes& bytes() const { return bytes_; }

   private:
    bool aligns_;
    Bytes bytes_;
  };

  Bytes serialised(bool cdr) const {
    constexpr std::uint64_t kSecond = 1'000'000'000;
    Writer out(cdr);
    if (!cdr) out.put(std::uint32_t{7});  // sequence number
    out.put(static_cast<std::uint32_t>(stamp / kSecond));
    out.put(static_cast<std::uint32_t>(stamp % kSecond));
    out.put(frame);
    out.put(timebase);
    out.put(static_cast<std::uint32_t>(points.size()));
    for (int k = 0; k < 4; ++k) out.put(std::uint8_t{0xee});  // lidar_id, rsvd
    out.put(static_cast<std::uint32_t>(points.size()));
    for (const Point& point : points) {
      out.put(point.offset_time);
      for (const float value : {point.x, point.y, point.z}) out.put(value);
      for (const std::uint8_t value : {point.reflectivity, point.tag, point.line}) out.put(value);
    }
    Bytes bytes = cdr ? Bytes{0, 1, 0, 0} : Bytes();
    bytes.insert(bytes.end(), out.bytes().begin(), out.bytes().end());
    return bytes;
  }
};

}  // namespace fleetmap::testing
