#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/sensor/ouster_metadata.hpp"
#include "fleetmap/sensor/packet_refusal.hpp"
#include "fleetmap/sensor/samples.hpp"
#include "fleetmap/sensor/scan.hpp"

namespace fleetmap::sensor {

/// UDP payload of a packet of the IMU.
inline constexpr std::size_t kOusterImuBytes = 48;

/// A measurement block: what all beams measured at one angle, at the same time.
struct OusterColumn {
  std::uint64_t time = 0;       ///< ns, by the device's clock
  std::size_t measurement = 0;  ///< its place in the turn: [0, columns_per_frame)
  ByteView pixels{};            ///< of the beams, within the packet's bytes
};

/// A lidar packet, valid as long as its bytes.
struct OusterPacket {
  std::uint32_t frame = 0;            ///< number of the turn
  std::vector<OusterColumn> columns;  ///< that were measured
};

/// Refuses another size than the metadata's, a column beyond the turn, and columns of two turns.
tl::expected<OusterPacket, PacketRefusal> read_ouster_packet(ByteView bytes, const OusterMetadata& metadata);

/// Appends the returns of a column in the frame `sensor`, ring by ring from the topmost one; intensity is the
/// calibrated reflectivity. `time` is that of the column, s after the scan's stamp.
void append_points(const OusterMetadata& metadata, const OusterColumn& column, double time,
                   std::vector<ScanPoint>& points);

/// A sample of an Ouster's IMU.
struct OusterImu {
  std::uint64_t time = 0;  ///< ns, by the device's clock, of the gyro
  Imu sample;              ///< without a stamp; its axes are those of `sensor`
};
/// Reads a packet of the IMU, whose units are g and deg/s. Refuses another size and values that are not
/// finite.
tl::expected<OusterImu, PacketRefusal> read_ouster_imu(ByteView bytes, const OusterMetadata& metadata);

}  // namespace fleetmap::sensor
