#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "fleetmap/sensor/ouster_packet.hpp"
#include "fleetmap/sensor/top_of_hour_clock.hpp"

namespace fleetmap::sensor {

/// Counters of the packets of one Ouster.
struct OusterCounters {
  std::uint64_t packets = 0;  ///< decoded, of the LiDAR
  /// Left out, since more than a tenth of a turn is missing at their beginning or end: the packets begin or
  /// end there, or the clock made a step.
  std::uint64_t incomplete_sweeps = 0;
};

/// Makes scans and IMU samples of the packets of one Ouster LiDAR. A scan is a turn as the device numbers
/// them; its stamp is the time of the column that came first. Both kinds of packets share the device's clock:
/// it is used as it is if it is within 1 s of UTC by the first packet (PTP), any other is moved by the least
/// lag.
class OusterSensor {
 public:
  explicit OusterSensor(OusterMetadata metadata) : metadata_(std::move(metadata)) {}

  /// Refuses a packet of a turn that is over, and columns that came already, too.
  tl::expected<void, PacketRefusal> add_lidar(ByteView packet, Stamp arrival);
  tl::expected<Imu, PacketRefusal> add_imu(ByteView packet, Stamp arrival);
  /// No more packets follow.
  void finish();
  /// The next scan that is complete.
  std::optional<Scan> take();

  const OusterMetadata& metadata() const { return metadata_; }
  const OusterCounters& counters() const { return counters_; }
  const TopOfHourClock& clock() const { return clock_; }

 private:
  /// The turn under way.
  struct Turn {
    std::uint32_t frame = 0;
    std::uint64_t begun = 0;  ///< ns by the device, of the column that came first
    Stamp stamp;              ///< of the same, in the hour that was resolved
    std::vector<bool> came;   ///< by the column
    Scan scan;
  };
  /// By how many turns a packet's is ahead; numbers wrap.
  int turns_ahead(std::uint32_t frame) const;
  void end_turn();
  void discard();

  OusterMetadata metadata_;
  TopOfHourClock clock_;
  std::optional<Turn> turn_;
  std::size_t late_in_a_row_ = 0;  ///< packets; more than a turn of them are a playback that begins again
  std::deque<Scan> complete_;
  OusterCounters counters_;
};

}  // namespace fleetmap::sensor
