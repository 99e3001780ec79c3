#pragma once

#include <deque>
#include <utility>

#include "fleetmap/core/time.hpp"
#include "fleetmap/exchange/token_bucket.hpp"

namespace fleetmap::exchange {

struct PaceConfig {
  double burst_seconds = 0.2;     ///< s, of the rate, that may go at once after silence
  double min_burst_bytes = 1400;  ///< B, at least one full fragment with its headers
  double peak = 1.1;              ///< of the rate, in any second
};

/// Lets bytes out at a rate that may change, and in no second more than `peak` times the rate: the buckets of
/// several robots alone would let their bursts fall into the same second.
class Pace {
 public:
  Pace(double bytes_per_second, const PaceConfig& config);

  void set_rate(double bytes_per_second, Stamp now);
  double rate() const { return bucket_.rate(); }
  double burst() const { return bucket_.burst(); }
  /// As TokenBucket::take. An item that is larger than a second's worth goes when nothing went for a second.
  bool take(double bytes, Stamp now, double reserve = 0.0);
  /// Something else sent `bytes` that count against the rate.
  void spend(double bytes, Stamp now);

 private:
  void note(double bytes, Stamp now);
  double burst_at(double rate) const;

  PaceConfig config_;
  TokenBucket bucket_;
  std::deque<std::pair<Stamp, double>> last_second_;  ///< what went, B
  double in_last_second_ = 0.0;                       ///< B
};

}  // namespace fleetmap::exchange
