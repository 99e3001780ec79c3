#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <utility>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/sensor/velodyne_model.hpp"

namespace fleetmap::testing {

inline void put_u16(Bytes& bytes, std::size_t at, unsigned value) {
  bytes[at] = static_cast<std::uint8_t>(value);
  bytes[at + 1] = static_cast<std::uint8_t>(value >> 8);
}

/// A Velodyne LiDAR that turns in a round room, as its manual describes its packets.
class VelodyneDevice {
 public:
  std::uint8_t product = 0x22;  ///< VLP-16
  std::uint8_t mode = 0x37;     ///< strongest return
  double turns_per_second = 10.0;
  unsigned range = 2500;  ///< of every return, in the device's units
  /// In its place: the range (m) at an azimuth (rad, clockwise from ahead) and an elevation (rad).
  std::function<double(double, double)> range_at{};
  /// Degrees of its field of view; blocks beyond are left out.
  double view_begin = 0.0, view_end = 360.0;

  /// `start`: by the device's clock, whose first block is fired at `azimuth` (deg).
  explicit VelodyneDevice(Duration start, double azimuth = 0.0) : start_(start), azimuth_(azimuth) {}

  struct Packet {
    Bytes bytes;
    Duration fired{};  ///< by the device's clock, its first firing
  };
  Packet next() {
    const bool dual = mode == 0x39;
    Packet packet{Bytes(1206), {}};
    for (std::size_t k = 0; k < 12; ++k) {
      if (!dual || k % 2 == 0) find_block_in_view();
      if (k == 0) packet.fired = start_ + from_seconds(after_);
      write_block(packet.bytes, k * 100, dual && k % 2 == 1);
      if (!dual || k % 2 == 1) after_ += block_period();
    }
    const auto us = static_cast<std::uint64_t>(packet.fired / std::chrono::microseconds(1)) % 3'600'000'000;
    put_u16(packet.bytes, 1200, static_cast<unsigned>(us & 0xffff));
    put_u16(packet.bytes, 1202, static_cast<unsigned>(us >> 16));
    packet.bytes[1204] = mode;
    packet.bytes[1205] = product;
    return packet;
  }
  double block_period() const {
    const sensor::VelodyneModel& model = *sensor::velodyne_model(product);
    return model.sequence_period * 32.0 / static_cast<double>(model.lasers_in_sequence);
  }

 private:
  double azimuth_now() const { return std::fmod(azimuth_ + 360.0 * turns_per_second * after_ + 1e-9, 360.0); }
  unsigned units_at(std::size_t firing) const {
    const sensor::VelodyneModel& model = *sensor::velodyne_model(product);
    const auto& laser = model.lasers[firing % model.lasers_in_sequence];
    const double azimuth = azimuth_now() * std::numbers::pi / 180.0 + laser.azimuth_offset;
    return static_cast<unsigned>(std::lround(range_at(azimuth, laser.elevation) / model.distance_unit));
  }
  void find_block_in_view() {
    while (azimuth_now() < view_begin || azimuth_now() > view_end) after_ += block_period();
  }
  void write_block(Bytes& bytes, std::size_t at, bool second_return) const {
    put_u16(bytes, at, 0xeeff);
    put_u16(bytes, at + 2, static_cast<unsigned>(std::lround(azimuth_now() * 100.0)) % 36000);
    for (std::size_t k = 0; k < 32; ++k) {
      const unsigned units = range_at ? units_at(k) : range;
      put_u16(bytes, at + 4 + 3 * k, second_return ? units / 2 : units);
      bytes[at + 6 + 3 * k] = static_cast<std::uint8_t>(k);
    }
  }

  Duration start_;
  double azimuth_;
  double after_ = 0.0;  ///< s from start to the next block
};

}  // namespace fleetmap::testing
