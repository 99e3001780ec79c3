#pragma once

#include <deque>
#include <optional>

#include "fleetmap/core/time.hpp"
#include "fleetmap/exchange/pace_config.hpp"
#include "fleetmap/exchange/token_bucket.hpp"

namespace fleetmap::exchange {

/// Lets bytes out at a rate that may change, and in no second more than `peak` times the rate: the buckets of
/// several robots alone would let their bursts fall into the same second.
class Pace {
 public:
  Pace(double bytes_per_second, const PaceConfig& config);

  void set_rate(double bytes_per_second, Stamp now);
  double rate() const { return bucket_.rate(); }
  double burst() const { return bucket_.burst(); }
  /// As TokenBucket::take. An item that would exceed the peak goes if none was taken for a second and it is
  /// larger than a second's share, or if none was for three seconds because other traffic left no room. So a
  /// second has at most the peak, or one item and the spent bytes; the rate holds for both together.
  bool take(double bytes, Stamp now, double reserve = 0.0);
  /// Something else sent `bytes` that count against the rate.
  void spend(double bytes, Stamp now);

 private:
  struct Sent {
    Stamp at;
    double bytes;
  };
  void note(const Sent& sent);
  bool may_exceed_peak(double bytes, Stamp now) const;
  void forget_before(Stamp now);
  double burst_at(double rate) const;

  PaceConfig config_;
  TokenBucket bucket_;
  std::deque<Sent> last_second_;
  double in_last_second_ = 0.0;                        ///< B
  std::optional<Stamp> first_requested_, last_taken_;  ///< of items
};

}  // namespace fleetmap::exchange
