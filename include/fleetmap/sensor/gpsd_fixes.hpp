#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/sensor/device_samples.hpp"

namespace fleetmap::sensor {

/// To be sent to gpsd when it is connected: reports as JSON lines from now on.
inline constexpr std::string_view kGpsdWatch = "?WATCH={\"enable\":true,\"json\":true};\n";

/// Fixes in the reports of gpsd (gpsd_json(5)): TPV lines; others, as SKY, are passed over. Stamps are the
/// receiver's UTC. The protocol does not define the confidence of its error estimates; they are taken as
/// standard deviations.
class GpsdFixes {
 public:
  struct Counters {
    std::uint64_t reports = 0;          ///< lines that are JSON objects with a class
    std::uint64_t malformed = 0;        ///< lines that are none, and those that are too long
    std::uint64_t without_time = 0;     ///< TPV
    std::uint64_t above_sea_level = 0;  ///< fixes without an altitude above the ellipsoid
  };
  DeviceSamples add(ByteView bytes);
  /// A new connection: what is left of a line of the last one is forgotten.
  void begin();
  const Counters& counters() const { return counters_; }
  /// Errors that gpsd reported since the last call.
  std::vector<std::string> take_errors();

 private:
  void read(const std::string& line, DeviceSamples& samples);

  std::string line_;
  bool too_long_ = false;
  Counters counters_;
  std::vector<std::string> errors_;
};

}  // namespace fleetmap::sensor
