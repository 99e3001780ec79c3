#pragma once

#include <algorithm>

#include "fleetmap/core/time.hpp"

namespace fleetmap::exchange {

/// Lets bytes out at a rate. In any window of T seconds it lets out at most rate * T + max(burst, largest
/// item).
class TokenBucket {
 public:
  TokenBucket(double bytes_per_second, double burst_bytes) : rate_(bytes_per_second), burst_(burst_bytes) {}

  /// Takes `bytes` if they may go now and `reserve` bytes are then left for others. An item above the burst
  /// goes when the bucket is full and leaves a debt. A clock that runs backwards refills nothing.
  bool take(double bytes, Stamp now, double reserve = 0.0) {
    refill(now);
    // The tolerance keeps rounding from holding back an item that needs the bucket exactly full.
    if (tokens_ + 1e-6 < std::min(bytes + reserve, burst_)) return false;
    tokens_ -= bytes;
    return true;
  }
  /// Takes `bytes` that were sent already; the debt is at most one second of the rate. A bucket whose first
  /// use this is begins empty: what is sent at a start is followed by no burst.
  void spend(double bytes, Stamp now) {
    const bool first = !started_;
    refill(now);
    if (first) tokens_ = 0.0;
    tokens_ = std::max(tokens_ - bytes, std::min(tokens_, -rate_));
  }
  /// Changes the rate; the tokens until `now` accumulate at the old rate.
  void set_rate(double bytes_per_second, double burst_bytes, Stamp now) {
    refill(now);
    rate_ = bytes_per_second;
    burst_ = burst_bytes;
    tokens_ = std::min(tokens_, burst_);
  }
  double rate() const { return rate_; }
  double burst() const { return burst_; }

 private:
  void refill(Stamp now) {
    if (started_ && now <= last_) return;
    tokens_ = started_ ? std::min(burst_, tokens_ + rate_ * to_seconds(now - last_)) : burst_;
    started_ = true;
    last_ = now;
  }

  double rate_;
  double burst_;
  double tokens_ = 0.0;
  bool started_ = false;
  Stamp last_{};
};

}  // namespace fleetmap::exchange
