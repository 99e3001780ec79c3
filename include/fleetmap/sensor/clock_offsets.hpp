#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/core/time.hpp"

namespace fleetmap::sensor {

enum class Source : std::uint8_t { kLidar, kImu, kGps, kWheel };
inline constexpr std::size_t kSources = 4;
const char* to_string(Source source);

/// Finds sensors whose stamps are of another clock than those of the others, from when samples come.
///
/// A sample comes some time after its stamp; the least of these lags over the last seconds is the same for
/// sensors of one clock, but for what a driver takes to hand a sample on. The clock that most sensors share
/// (of equally many, the one nearest to the computer's) is taken as right. Stamps that are more than kWrong
/// off are corrected, to about 0.1 s; what is off by less may be a slow driver and is only told.
class ClockOffsets {
 public:
  static constexpr double kTold = 0.5;   ///< s
  static constexpr double kWrong = 1.0;  ///< s

  /// `arrival` is of a clock that nobody sets.
  void add(Source source, Stamp stamp, Stamp arrival);
  /// The stamps of `source` contradict those of another sensor, and it is too early to say which is right:
  /// in the first 1.5 s of a sensor.
  bool unclear(Source source) const;
  /// What is to be added to the stamps of `source`; zero unless they are wrong.
  Duration correction(Source source) const;
  /// How far the stamps of `source` are behind those of the clock that is right (s); nothing until that is
  /// known.
  std::optional<double> behind(Source source) const;
  /// Sentences for a person, each once.
  std::vector<std::string> take_news();

 private:
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  struct Track {
    std::optional<Stamp> begun;  ///< arrival of the first sample
    Stamp window_begun;
    double before = kNone, now = kNone;  ///< s, least lag in the window before and in this one
    std::optional<Stamp> late_since;     ///< arrival of the first of the samples in a row that are far later
    int late = 0;
    double least_late = kNone;  ///< s
    bool known = false;
    double correction = 0.0;  ///< s
    double told = 0.0;        ///< s, the offset that was told last
    std::optional<Stamp> untold_since;
    double lag() const { return before < now ? before : now; }
  };
  /// The stamps have made a step; true when that is certain.
  static bool stepped(Track& track, double lag, Stamp arrival);
  void judge(Stamp since, Stamp arrival);
  void tell(Source source, double behind, Stamp arrival);
  std::optional<double> right_lag() const;

  std::array<Track, kSources> tracks_;
  std::optional<Stamp> last_arrival_;
  std::vector<std::string> news_;
};

}  // namespace fleetmap::sensor
