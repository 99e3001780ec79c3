#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <functional>
#include <string>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/time.hpp"

namespace fleetmap::testing {

/// An Ouster LiDAR with 16 beams, as the software user manual describes its metadata and packets.
class OusterDevice {
 public:
  static constexpr std::size_t kBeams = 16;

  std::string profile = "LEGACY";
  std::size_t columns = 1024, columns_per_packet = 16;
  double turns_per_second = 10.0;
  std::uint32_t frame = 600;
  /// mm, of a column and a beam; of the second return where there is one.
  std::function<std::uint32_t(std::size_t, std::size_t)> range = [](std::size_t, std::size_t) {
    return 5000u;
  };
  std::function<std::uint32_t(std::size_t, std::size_t)> second_range = [](std::size_t, std::size_t) {
    return 0u;
  };

  /// `start`: of the first column, by the device's clock.
  explicit OusterDevice(Duration start, std::size_t first_column = 0)
      : start_(start), column_(first_column) {}

  /// deg; beam 0 is the topmost.
  static double altitude(std::size_t beam) { return 15.0 - 2.0 * static_cast<double>(beam); }
  static double azimuth(std::size_t beam) {
    constexpr double kOffsets[] = {4.2, 1.4, -1.4, -4.2};
    return kOffsets[beam % 4];
  }
  static constexpr double kBeamOrigin = 15.806;  ///< mm
  static constexpr double kHeight = 36.18;       ///< mm, of the LiDAR's origin in the sensor's frame

  /// Flat as those of firmware 2; `sections`: as those of firmware 3.
  std::string metadata(bool sections = false) const {
    std::string altitudes, azimuths;
    for (std::size_t k = 0; k < kBeams; ++k) {
      altitudes += (k == 0 ? "" : ", ") + std::to_string(altitude(k));
      azimuths += (k == 0 ? "" : ", ") + std::to_string(azimuth(k));
    }
    const std::string format =
        "\"columns_per_frame\": " + std::to_string(columns) +
        ", \"columns_per_packet\": " + std::to_string(columns_per_packet) + ", \"column_window\": [0, " +
        std::to_string(columns - 1) +
        "], \"pixels_per_column\": 16, \"udp_profile_imu\": " + "\"LEGACY\", \"udp_profile_lidar\": \"" +
        profile + "\"";
    const std::string beams = "\"beam_altitude_angles\": [" + altitudes + "], \"beam_azimuth_angles\": [" +
                              azimuths + "], \"lidar_origin_to_beam_origin_mm\": 15.806";
    const std::string lidar =
        "\"lidar_to_sensor_transform\": [-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 36.18, 0, 0, 0, 1]";
    const std::string imu =
        "\"imu_to_sensor_transform\": [1, 0, 0, 6.253, 0, 1, 0, -11.775, 0, 0, 1, 7.645, 0, 0, 0, 1]";
    const std::string info = "\"prod_line\": \"OS-1-16\", \"prod_sn\": \"122\"";
    const auto part = [&](const char* name, const std::string& content) {
      return sections ? "\"" + std::string(name) + "\": {" + content + "}" : content;
    };
    return "{" + part("beam_intrinsics", beams) + ", " + part("lidar_intrinsics", lidar) + ", " +
           part("imu_intrinsics", imu) + ", " + part("sensor_info", info) + ", \"" +
           (sections ? "lidar_data_format" : "data_format") + "\": {" + format + "}}";
  }

  struct Packet {
    Bytes bytes;
    Duration fired{}, sent{};  ///< by the device's clock, of its first and last column
  };
  Packet next() {
    Packet packet;
    packet.fired = time_of_column(0);
    packet.sent = time_of_column(columns_per_packet - 1);
    if (!legacy()) {
      put(packet.bytes, std::uint16_t{1});
      put(packet.bytes, static_cast<std::uint16_t>(wide() ? 0 : frame));
      put(packet.bytes, static_cast<std::uint32_t>(wide() ? frame : 0));
      packet.bytes.resize(32);
    }
    for (std::size_t k = 0; k < columns_per_packet; ++k) put_column(packet.bytes, k);
    if (!legacy()) packet.bytes.resize(packet.bytes.size() + 32);
    count_ += columns_per_packet;
    column_ += columns_per_packet;
    if (column_ >= columns) column_ = 0, ++frame;
    return packet;
  }
  double column_period() const { return 1.0 / (turns_per_second * static_cast<double>(columns)); }

  /// A packet of the IMU: g and deg/s.
  static Bytes imu(Duration time, const std::array<float, 3>& acceleration,
                   const std::array<float, 3>& rate) {
    Bytes bytes;
    put(bytes, std::uint64_t{0});
    put(bytes, static_cast<std::uint64_t>(time.count() - 500'000));
    put(bytes, static_cast<std::uint64_t>(time.count()));
    for (const float value : acceleration) put(bytes, std::bit_cast<std::uint32_t>(value));
    for (const float value : rate) put(bytes, std::bit_cast<std::uint32_t>(value));
    return bytes;
  }

 private:
  bool legacy() const { return profile == "LEGACY"; }
  bool wide() const { return profile.starts_with("FUSA"); }
  Duration time_of_column(std::size_t k) const {
    return start_ + from_seconds(column_period() * static_cast<double>(count_ + k));
  }
  template <std::unsigned_integral T>
  static void put(Bytes& bytes, T value) {
    for (std::size_t k = 0; k < sizeof(T); ++k) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * k)));
  }
  void put_column(Bytes& bytes, std::size_t k) const {
    const std::size_t column = column_ + k;
    put(bytes, static_cast<std::uint64_t>(time_of_column(k).count()));
    put(bytes, static_cast<std::uint16_t>(column));
    if (legacy()) {
      put(bytes, static_cast<std::uint16_t>(frame));
      put(bytes, static_cast<std::uint32_t>(column * 90'112 / columns));
    } else {
      put(bytes, std::uint16_t{1});
    }
    for (std::size_t beam = 0; beam < kBeams; ++beam)
      put_pixel(bytes, range(column, beam), second_range(column, beam), beam);
    if (legacy()) put(bytes, std::uint32_t{0xffffffff});
  }
  /// Reflectivity is the number of the beam, that of a second return 100 more; other fields are all ones.
  void put_pixel(Bytes& bytes, std::uint32_t first, std::uint32_t second, std::size_t beam) const {
    const auto reflectivity = static_cast<std::uint32_t>(beam);
    const auto low_rate = [&](std::uint32_t mm, std::uint32_t reflects) {
      put(bytes, static_cast<std::uint16_t>(mm / 8 | 0x8000));
      put(bytes, static_cast<std::uint8_t>(reflects));
      put(bytes, std::uint8_t{0xff});
    };
    constexpr std::uint32_t kOther = 0xffffffff;
    if (profile == "LEGACY" || profile == "RNG19_RFL8_SIG16_NIR16") {
      put(bytes, first | (profile == "LEGACY" ? 0xf0000000 : 0x00f80000));
      put(bytes, reflectivity | 0xffff0000);
      put(bytes, kOther);
    } else if (profile == "RNG19_RFL8_SIG16_NIR16_DUAL") {
      put(bytes, first | 0x00f80000 | reflectivity << 24);
      put(bytes, second | 0x00f80000 | (reflectivity + 100) << 24);
      put(bytes, kOther);
      put(bytes, kOther);
    } else {
      low_rate(first, reflectivity);
      if (profile.ends_with("DUAL")) low_rate(second, reflectivity + 100);
    }
  }

  Duration start_;
  std::size_t column_;
  std::size_t count_ = 0;  ///< of columns
};

}  // namespace fleetmap::testing
