#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace fleetmap::sensor {

/// The lasers of a Velodyne LiDAR, by its manual. A laser's index is its place in a data block.
struct VelodyneModel {
  static constexpr std::size_t kMaxLasers = 32;
  struct Laser {
    float elevation = 0.0f;       ///< rad
    float azimuth_offset = 0.0f;  ///< rad, clockwise as the azimuth; added to that of the block
    double delay = 0.0;           ///< s from the first firing of a sequence
    std::uint16_t ring = 0;       ///< by elevation, 0 is the lowest, as in odometry::vlp16()
  };

  std::string_view name;
  std::size_t lasers_in_sequence = 0;  ///< 16 or 32; a data block holds 32 returns
  double sequence_period = 0.0;        ///< s from one firing sequence to the next
  float distance_unit = 0.0f;          ///< m
  std::array<Laser, kMaxLasers> lasers{};
};

/// The model with a product id (the last byte of a data packet), or null. VLP-16 and Puck LITE (0x22), Puck
/// Hi-Res (0x24), HDL-32E (0x21), VLP-32C (0x28). Angles and firing times are those of the manuals (63-9243,
/// 63-9113, 63-9325), without the vertical offsets of some mm between the lasers, which no common decoder
/// applies.
const VelodyneModel* velodyne_model(std::uint8_t product);

}  // namespace fleetmap::sensor
