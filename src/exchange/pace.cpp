#include "fleetmap/exchange/pace.hpp"

#include <algorithm>

namespace fleetmap::exchange {
namespace {

constexpr std::chrono::seconds kSecond{1};
/// An item that fits into a second waits so long for other traffic to leave room, then it goes above the
/// peak.
constexpr std::chrono::seconds kLongestWait{3};

}  // namespace

Pace::Pace(double bytes_per_second, const PaceConfig& config)
    : config_(config), bucket_(bytes_per_second, burst_at(bytes_per_second)) {}

double Pace::burst_at(double rate) const {
  return std::max(config_.burst_seconds * rate, config_.min_burst_bytes);
}

void Pace::set_rate(double bytes_per_second, Stamp now) {
  bucket_.set_rate(bytes_per_second, burst_at(bytes_per_second), now);
}

void Pace::forget_before(Stamp now) {
  while (!last_second_.empty() && now - last_second_.front().at >= kSecond) {
    in_last_second_ -= last_second_.front().bytes;
    last_second_.pop_front();
  }
  if (last_second_.empty()) in_last_second_ = 0.0;  // rounding adds up
}

bool Pace::may_exceed_peak(double bytes, Stamp now) const {
  const bool fits_alone = bytes <= config_.peak * rate();
  if (!fits_alone) return !last_taken_ || now - *last_taken_ >= kSecond;
  return now - last_taken_.value_or(*first_requested_) >= kLongestWait;
}

bool Pace::take(double bytes, Stamp now, double reserve) {
  forget_before(now);
  if (!first_requested_) first_requested_ = now;
  const bool below_peak = in_last_second_ + bytes <= config_.peak * rate();
  if (!below_peak && !may_exceed_peak(bytes, now)) return false;
  if (!bucket_.take(bytes, now, reserve)) return false;
  note({now, bytes});
  last_taken_ = now;
  return true;
}

void Pace::spend(double bytes, Stamp now) {
  forget_before(now);
  bucket_.spend(bytes, now);
  note({now, bytes});
}

void Pace::note(const Sent& sent) {
  last_second_.push_back(sent);
  in_last_second_ += sent.bytes;
}

}  // namespace fleetmap::exchange
