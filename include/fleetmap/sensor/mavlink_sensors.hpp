#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "fleetmap/sensor/device_clock.hpp"
#include "fleetmap/sensor/device_samples.hpp"
#include "fleetmap/sensor/mavlink_messages.hpp"

namespace fleetmap::sensor {

/// IMU and GPS of an autopilot that speaks MAVLink. Samples are stamped by the autopilot's clock, mapped to
/// this computer's (DeviceClock); times since the Unix epoch are brought to the autopilot's by SYSTEM_TIME.
///
/// HIGHRES_IMU is used where it comes, else SCALED_IMU; the last ATTITUDE_QUATERNION, turned on to the
/// sample's time, gives the orientation. The IMU's frame is the autopilot's board turned to x forward, y
/// left, z up.
class MavlinkSensors {
 public:
  struct Counters {
    MavlinkCounters frames;
    std::uint64_t of_other_systems = 0;  ///< messages of another sender than the first
    std::uint64_t unusable = 0;          ///< that decode_mavlink leaves out
    std::uint64_t unplaced = 0;         ///< with a time since the epoch, before a SYSTEM_TIME that relates it
    std::uint64_t above_sea_level = 0;  ///< fixes without an altitude above the ellipsoid
    std::uint64_t restarts = 0;         ///< of the autopilot's clock
  };

  /// `arrival` is when the bytes came, by the clock of the stamps.
  DeviceSamples add(ByteView bytes, Stamp arrival);
  /// To be sent about once a second; the answer comes with the other bytes.
  Bytes clock_request(Stamp now);

  Counters counters() const;
  const DeviceClock& clock() const { return clock_; }

 private:
  void handle(const MavlinkSystemTime& message, Stamp arrival, DeviceSamples& samples);
  void handle(const MavlinkGps& message, Stamp arrival, DeviceSamples& samples);
  void handle(const MavlinkAttitude& message, Stamp arrival, DeviceSamples& samples);
  void handle(const MavlinkImu& message, Stamp arrival, DeviceSamples& samples);
  void handle(const MavlinkTimesync& message, Stamp arrival, DeviceSamples& samples);
  bool is_source(const MavlinkFrame& frame, Stamp arrival);
  void hear_time(Duration boot, Stamp arrival);
  /// Empty while a time since the epoch cannot be related.
  std::optional<Duration> boot_time(const MavlinkTime& time);

  MavlinkFrames frames_;
  DeviceClock clock_;
  std::optional<std::pair<std::uint8_t, std::uint8_t>> source_;  ///< system and component
  Stamp last_message_{};
  std::optional<Duration> unix_minus_boot_;
  std::optional<MavlinkAttitude> attitude_;
  std::optional<Stamp> last_high_resolution_;
  std::uint8_t sequence_ = 0;
  Counters counters_;
};

}  // namespace fleetmap::sensor
