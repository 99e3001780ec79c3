#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fleetmap/core/time.hpp"

namespace fleetmap::sensor {

/// The silence of a sensor that is a gap, and that which is a finding.
struct SilenceRule {
  std::string sensor;           ///< in sentences
  double min_gap = 3.0;         ///< s
  double min_intervals = 10.0;  ///< usual ones of the sensor, in a gap
  double min_moved = 0.0;     ///< m that the robot drove in a gap, for drivers that are silent at standstill
  double found_share = 0.4;   ///< of the time since the first sample that is in gaps
  double found_after = 10.0;  ///< s in gaps
  double found_in_one = 1e9;  ///< s of one gap, whatever the share
  std::string remedy;
  std::string empty_remedy;  ///< behind the number of messages that came and say nothing
};
SilenceRule fix_silence();
SilenceRule wheel_silence();

/// Gaps between the samples of a sensor. Its time is that of another one, by which the drive goes on, so that
/// a sensor that ends is noticed and stamps of different clocks do not matter.
class StreamSilence {
 public:
  explicit StreamSilence(SilenceRule rule) : rule_(std::move(rule)) {}
  void add(Stamp stamp);
  /// A message that says nothing, as that of a receiver without a position.
  void add_empty();
  /// The drive went on; `moved` is in metres.
  void pass(double seconds, double moved);
  /// Since the last call; once, when gaps have taken too much of the drive.
  std::optional<std::string> take_finding();
  /// A sentence on all gaps; empty if there are none.
  std::optional<std::string> note() const;

 private:
  struct Gap {
    double from = 0.0, to = 0.0;  ///< s of the drive
    double length() const { return to - from; }
  };
  bool is_gap() const;
  void check();
  void check_empty();
  std::string reason() const;

  SilenceRule rule_;
  std::vector<double> first_intervals_;   ///< s
  std::optional<double> usual_interval_;  ///< s
  std::optional<Stamp> last_;
  std::optional<double> first_at_;    ///< s of the drive
  double now_ = 0.0, last_at_ = 0.0;  ///< s of the drive
  double moved_ = 0.0;                ///< m since the last sample
  std::size_t empty_ = 0;             ///< messages since the last sample
  double first_empty_at_ = 0.0;       ///< s of the drive
  double in_gaps_ = 0.0;              ///< s, of gaps that ended
  std::size_t gaps_ = 0;              ///< that ended
  Gap longest_;                       ///< of these
  bool found_ = false, empty_found_ = false;
  std::optional<std::string> finding_;
};

}  // namespace fleetmap::sensor
