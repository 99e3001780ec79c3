#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/core/time.hpp"
#include "fleetmap/sensor/clock_drift.hpp"
#include "fleetmap/sensor/min_lag_filter.hpp"

namespace fleetmap::sensor {

/// A sensor whose stamps are compared with those of the others.
enum class Source : std::uint8_t { kLidar, kImu, kGps, kWheel };
inline constexpr std::size_t kSources = 4;
const char* to_string(Source source);

/// A sentence on a clock, for a person.
struct ClockNews {
  std::string text;
  /// The stamps are right all the same: corrected by a difference that time scales have, or by a drift that
  /// is followed, or they agree again.
  bool settled = false;
};

/// Finds sensors whose stamps are of another clock than those of the others, from when samples arrive: live
/// by the bus's clock, in recordings by the times at which they were recorded.
///
/// The clock that most sensors share (of equally many, the one nearest to the computer's) is taken as right.
/// Stamps that are more than kWrong off are corrected: exactly, where the difference is one that time scales
/// have, else to about 0.1 s, which drivers take to hand a sample on. A smaller difference may come from a
/// slow driver and is only reported. A clock that drifts against the right one is reported in ppm, and
/// followed. The stamps of a sensor that is the only one are compared with the arrivals, reported and used as
/// they are: nothing shows which of the two clocks is wrong, and no other stamp contradicts them.
class ClockOffsets {
 public:
  static constexpr double kReportedOffset = 0.5;  ///< s
  static constexpr double kWrong = 1.0;           ///< s

  /// `arrival` is of a steady clock.
  void add(Source source, Stamp stamp, Stamp arrival);
  /// The stamps of `source` contradict those of another sensor, and the wrong one cannot be determined yet:
  /// in its first 1.5 s, or, while its samples may only be late, in its first 10 s; and for 1.5 s after it
  /// went ahead.
  bool unclear(Source source) const;
  /// The correction to add to the stamps of `source`; zero unless they are wrong.
  Duration correction(Source source) const;
  /// The delay (s) of the stamps of `source` behind those of the reference clock, behind the arrivals while
  /// it is the only sensor; empty until it is determined.
  std::optional<double> behind(Source source) const;
  /// By how much the clock of `source` is too slow (1e-6), once it is found to drift.
  std::optional<double> slow_ppm(Source source) const;
  /// The news since the last call.
  std::vector<ClockNews> take_news();
  /// Its sentences.
  std::vector<std::string> take_warnings();

 private:
  struct Track {
    std::optional<Stamp> begun;  ///< arrival of the first sample
    Stamp last_stamp;
    MinLagFilter envelope;
    ClockDrift drift;
    std::optional<double> behind_at_first;  ///< s, when the first bucket of `drift` was complete
    bool known = false;
    bool certain = false;                 ///< an offset that is found next is not that of late samples
    std::optional<Stamp> leap_begun;      ///< since when the correction is wrong, if samples are not late
    bool is_off = false;                  ///< by a constant offset that is corrected
    std::optional<double> slow;           ///< s/s, while it drifts
    std::optional<double> reported_slow;  ///< s/s, the drift in the last report
    double correction = 0.0;              ///< s
    double reported = 0.0;                ///< s, the offset in the last report
    std::optional<Stamp> unreported_since;
    double lag() const { return envelope.min(); }
    void forget_drift() {
      drift.reset();
      behind_at_first.reset();
      slow.reset();
    }
  };
  const Track& track(Source source) const { return tracks_[static_cast<std::size_t>(source)]; }
  /// Only one sensor was heard.
  bool alone() const;
  std::size_t sharing(double lag) const;
  /// It may be that the samples are only late.
  bool may_be_late(const Track& track) const;
  std::optional<double> right_lag() const;
  std::optional<ClockDrift::Line> right_rate() const;
  void find_drifts();
  void check(Source source, double right, Duration since, Stamp arrival);
  void report_offset(Source source, double offset, Stamp arrival);
  ClockNews offset_report(Source source, double offset, bool is_off) const;
  void report_drift(Source source, double slow);

  std::array<Track, kSources> tracks_;
  std::optional<Stamp> last_arrival_;
  std::vector<ClockNews> news_;
};

}  // namespace fleetmap::sensor
