#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "fleetmap/sensor/top_of_hour_clock.hpp"
#include "fleetmap/sensor/velodyne_packet.hpp"

namespace fleetmap::sensor {

/// Counters of the packets of one Velodyne.
struct VelodyneCounters {
  std::uint64_t packets = 0;  ///< decoded
  /// Left out, since more than a tenth of a turn is missing at their beginning or end: the packets begin or
  /// end there, the clock made a step, or the device does not turn.
  std::uint64_t incomplete_sweeps = 0;
};

/// Makes scans of the packets of one Velodyne LiDAR. A scan begins where the azimuth passes 0 (ahead); its
/// stamp is the time of its first firing, with ring and time of each point.
class VelodyneSweeps {
 public:
  /// `arrival` is when the packet was received; it resolves the hour (TopOfHourClock).
  tl::expected<void, PacketRefusal> add(ByteView packet, Stamp arrival);
  /// No more packets follow.
  void finish();
  /// The next scan that is complete.
  std::optional<Scan> take();

  const VelodyneCounters& counters() const { return counters_; }
  const TopOfHourClock& clock() const { return clock_; }

 private:
  /// The sweep under way.
  struct Sweep {
    Stamp begun;            ///< by the device's clock
    bool has_begin = true;  ///< no packets are missing there
    int azimuth = 0;        ///< of its last block, 1/100 deg
    Scan scan;
  };
  void add_block(const VelodyneModel& model, const VelodyneBlock& block, Stamp fired);
  void end_sweep(bool has_end);
  void discard();

  TopOfHourClock clock_;
  const VelodyneModel* model_ = nullptr;
  std::optional<Sweep> sweep_;
  std::deque<Scan> complete_;
  VelodyneCounters counters_;
};

}  // namespace fleetmap::sensor
