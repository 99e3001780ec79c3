#pragma once

#include <optional>

#include "fleetmap/sensor/device_samples.hpp"
#include "fleetmap/sensor/nmea_sentences.hpp"

namespace fleetmap::sensor {

/// Fixes of a GPS receiver that sends NMEA 0183: position of GGA, standard deviations of GST where it comes,
/// date of RMC, or else the day nearest to the arrival. Stamps are the receiver's UTC.
class NmeaFixes {
 public:
  DeviceSamples add(ByteView bytes, Stamp arrival);
  const NmeaCounters& counters() const { return sentences_.counters(); }
  /// Fixes whose GGA does not state the geoid's height.
  std::uint64_t above_sea_level() const { return above_sea_level_; }

 private:
  /// A moment in UTC and when it was heard.
  struct Dated {
    Stamp utc, arrival;
  };
  void handle(const NmeaOther&, Stamp, DeviceSamples&) {}
  void handle(const NmeaGga& gga, Stamp arrival, DeviceSamples& samples);
  void handle(const NmeaRmc& rmc, Stamp arrival, DeviceSamples& samples);
  void handle(const NmeaGst& gst, Stamp arrival, DeviceSamples& samples);
  /// The instant of a time of the day.
  Stamp utc(Duration time, Stamp arrival) const;
  void finish(DeviceSamples& samples);

  NmeaSentences sentences_;
  std::optional<Dated> dated_;
  std::optional<Fix> waiting_;  ///< for its standard deviations
  Duration waiting_time_{};
  std::optional<NmeaGst> gst_;  ///< the last one
  std::optional<Stamp> gst_arrival_;
  std::uint64_t above_sea_level_ = 0;
};

}  // namespace fleetmap::sensor
