#pragma once

#include <deque>
#include <limits>
#include <optional>

#include "fleetmap/core/time.hpp"

namespace fleetmap::sensor {

/// The rate of one sensor's clock against the arrival clock: a straight line, by least squares, through the
/// least lags of every 30 s of the last half hour. Delays only add to the lag of a sample, so the least lag
/// of many samples is free of them.
class ClockDrift {
 public:
  static constexpr Duration kBucket = std::chrono::seconds(30);
  static constexpr std::size_t kMinBuckets = 10, kMax = 60;  ///< buckets

  struct Line {
    double slope = 0.0;      ///< s of lag a second; positive: the sensor's clock is slow
    double deviation = 0.0;  ///< s/s, standard deviation of the slope
    double scatter = 0.0;    ///< s, RMS of the buckets about the line: large where a clock made a step
    double span = 0.0;       ///< s, from the first bucket to the last
  };

  /// True when a bucket was completed.
  bool add(Stamp arrival, double lag);
  void reset();
  /// Nothing before kMinBuckets buckets are complete.
  std::optional<Line> line() const;
  /// The least lag of the first bucket since the last reset (s).
  std::optional<double> first() const { return first_; }

 private:
  struct Bucket {
    double time = 0.0;  ///< s since begun_
    double lag = 0.0;   ///< s, above first_
  };
  std::optional<Stamp> begun_, bucket_begun_;
  double min_ = std::numeric_limits<double>::infinity();
  double min_time_ = 0.0;
  std::optional<double> first_;
  std::deque<Bucket> buckets_;
};

}  // namespace fleetmap::sensor
