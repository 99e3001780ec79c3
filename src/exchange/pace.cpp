#include "fleetmap/exchange/pace.hpp"

#include <algorithm>

namespace fleetmap::exchange {

Pace::Pace(double bytes_per_second, const PaceConfig& config)
    : config_(config), bucket_(bytes_per_second, burst_at(bytes_per_second)) {}

double Pace::burst_at(double rate) const {
  return std::max(config_.burst_seconds * rate, config_.min_burst_bytes);
}

void Pace::set_rate(double bytes_per_second, Stamp now) {
  bucket_.set_rate(bytes_per_second, burst_at(bytes_per_second), now);
}

bool Pace::take(double bytes, Stamp now, double reserve) {
  while (!last_second_.empty() && now - last_second_.front().first >= std::chrono::seconds(1)) {
    in_last_second_ -= last_second_.front().second;
    last_second_.pop_front();
  }
  if (last_second_.empty()) in_last_second_ = 0.0;  // rounding adds up
  const bool below_peak = in_last_second_ + bytes <= config_.peak * rate();
  if (!below_peak && !last_second_.empty()) return false;
  if (!bucket_.take(bytes, now, reserve)) return false;
  note(bytes, now);
  return true;
}

void Pace::spend(double bytes, Stamp now) {
  bucket_.spend(bytes, now);
  note(bytes, now);
}

void Pace::note(double bytes, Stamp now) {
  last_second_.emplace_back(now, bytes);
  in_last_second_ += bytes;
}

}  // namespace fleetmap::exchange
