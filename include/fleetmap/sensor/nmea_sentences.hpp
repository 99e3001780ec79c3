#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/geometry/geodesy.hpp"

namespace fleetmap::sensor {

/// Counters of a stream of NMEA sentences.
struct NmeaCounters {
  std::uint64_t sentences = 0;        ///< whole, of any type
  std::uint64_t wrong_checksums = 0;  ///< or none
  std::uint64_t cut = 0;              ///< another one began in them, or they are too long
  std::uint64_t malformed = 0;        ///< whole, with a field that is none
};

/// Finds sentences of NMEA 0183 ("$GPGGA,...*47") in a stream that may begin anywhere and lose or damage
/// bytes.
class NmeaSentences {
 public:
  /// From behind '$' up to '*', of those whose checksum is right.
  std::vector<std::string> add(ByteView bytes);
  const NmeaCounters& counters() const { return counters_; }
  void count_malformed() { ++counters_.malformed; }

 private:
  void end(std::vector<std::string>& sentences);

  std::optional<std::string> sentence_;  ///< behind its '$'
  NmeaCounters counters_;
};

/// Times are of the day, UTC.
struct NmeaGga {
  Duration time{};
  int quality = 0;  ///< 0: no fix
  /// Altitude above the ellipsoid, if the sentence states the height of the geoid; else above sea level.
  GeoPoint position{};
  bool has_geoid = false;
};
/// RMC: validity and date of a fix.
struct NmeaRmc {
  Duration time{};
  bool valid = false;
  Stamp midnight;  ///< at which its date begins
};
/// GST: standard deviations of a fix.
struct NmeaGst {
  Duration time{};
  double sigma_east = 0.0, sigma_north = 0.0, sigma_up = 0.0;  ///< m
};
/// A sentence of any other type.
struct NmeaOther {};
/// A sentence that has no time yet is no fix.
using NmeaSentence = std::variant<NmeaOther, NmeaGga, NmeaRmc, NmeaGst>;

/// GGA, RMC and GST of any talker. Empty if a field is malformed.
std::optional<NmeaSentence> read_nmea(std::string_view sentence);

}  // namespace fleetmap::sensor
