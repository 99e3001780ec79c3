#pragma once

#include <deque>
#include <limits>
#include <optional>

#include "fleetmap/core/time.hpp"

namespace fleetmap::sensor {

/// The least lag (arrival minus stamp) of one sensor's samples over the last half minute. A late sample is
/// honest, since a driver or a busy computer may hold it back; an early one is not possible. So the envelope
/// falls at once, and rises only when
/// - no sample was on time for the whole window,
/// - three in a row bear stamps from before those that came already (the clock was set back), or
/// - samples come later than any queue holds them, all by the same lag.
class MinLagFilter {
 public:
  static constexpr double kLate = 1.0;         ///< s above the envelope: not on time
  static constexpr double kMaxLateness = 5.0;  ///< s that drivers and queues hold a sample back at most

  /// True when the stamps made a step: what was learnt before is forgotten.
  bool add(Stamp stamp, Stamp arrival);
  bool empty() const { return buckets_.empty(); }
  /// s; infinity before the first sample.
  double min() const { return min_; }

 private:
  /// Samples in a row that are not on time.
  struct LateRun {
    Stamp begun;
    int samples = 0;
    double min = 0.0, max = 0.0;  ///< s, their lags
    bool set_back = true;         ///< all of them are from before the newest stamp
  };
  struct Bucket {
    Stamp begun;
    double min = 0.0;
  };
  bool stepped(Stamp stamp, Stamp arrival, double lag);
  void insert(Stamp arrival, double lag);

  static constexpr double kNone = std::numeric_limits<double>::infinity();
  std::deque<Bucket> buckets_;
  double min_ = kNone;
  Stamp newest_{};
  std::optional<LateRun> late_;
};

}  // namespace fleetmap::sensor
