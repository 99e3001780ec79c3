#pragma once

#include <cstddef>
#include <cstdint>
#include <tl/expected.hpp>
#include <vector>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/sensor/packet_refusal.hpp"
#include "fleetmap/sensor/scan.hpp"
#include "fleetmap/sensor/velodyne_model.hpp"

namespace fleetmap::sensor {

/// UDP payload of a data packet: 12 blocks of 100 bytes, timestamp, return mode, product id.
inline constexpr std::size_t kVelodynePacketBytes = 1206;

/// A data block of returns.
struct VelodyneBlock {
  int azimuth = 0;     ///< 1/100 deg, [0, 36000), at its first firing; clockwise from above, 0 is forward (x)
  double step = 0.0;   ///< 1/100 deg from its first firing to that of the next block
  double time = 0.0;   ///< s from the packet's timestamp to its first firing
  ByteView returns{};  ///< 32 times distance (uint16) and intensity (uint8), within the packet's bytes
};

/// A data packet, valid as long as its bytes.
struct VelodynePacket {
  const VelodyneModel* model = nullptr;
  std::uint32_t microseconds = 0;  ///< of its first firing, within the hour
  /// 12; of dual returns the 6 that hold the last return of each firing, since dust, rain and leaves in front
  /// of a surface leave the earlier ones.
  std::vector<VelodyneBlock> blocks;
};

/// Refuses another size than 1206 bytes, a block without its flag (0xeeff) or with an azimuth of 360 deg or
/// more, an unknown return mode (strongest 0x37, last 0x38, dual 0x39 are known) and an unknown product id.
/// Packets of the HDL-32E from before it sent these two bytes are therefore refused.
tl::expected<VelodynePacket, PacketRefusal> read_velodyne_packet(ByteView bytes);

/// Appends the returns of a block, in order of firing: x forward, y left, z up; azimuth interpolated by the
/// times at which the lasers fire. `start` is the time of its first firing, s after the scan's stamp.
void append_points(const VelodyneModel& model, const VelodyneBlock& block, double start,
                   std::vector<ScanPoint>& points);

}  // namespace fleetmap::sensor
