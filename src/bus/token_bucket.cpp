#include "fleetmap/bus/token_bucket.hpp"

#include <algorithm>
#include <cmath>

namespace fleetmap::bus {

std::size_t datagrams(std::size_t payload, const WireOverhead& overhead) {
  return std::max<std::size_t>(1,
                               (payload + overhead.max_datagram_payload - 1) / overhead.max_datagram_payload);
}

std::size_t wire_bytes(std::size_t payload, const WireOverhead& overhead) {
  return payload + datagrams(payload, overhead) * (overhead.ip_udp + overhead.rtps);
}

Status TokenBucket::Config::validate() const {
  if (!(std::isfinite(rate_bit_s) && rate_bit_s > 0.0))
    return failure("rate_bit_s must be finite and > 0 bit/s");
  if (burst_bytes == 0) return failure("burst_bytes must be > 0");
  return {};
}

TokenBucket::TokenBucket(const Config& config, Stamp now)
    : config_(config), level_(static_cast<double>(config.burst_bytes)), updated_(now) {}

double TokenBucket::level(Stamp now) const {
  const double elapsed = std::max(0.0, to_seconds(now - updated_));
  return std::min(static_cast<double>(config_.burst_bytes), level_ + elapsed * config_.rate_bit_s / 8.0);
}

bool TokenBucket::try_take(std::size_t bytes, Stamp now) {
  if (time_until(bytes, now) > Duration::zero()) return false;
  level_ = level(now) - static_cast<double>(bytes);
  updated_ = std::max(updated_, now);
  return true;
}

Duration TokenBucket::time_until(std::size_t bytes, Stamp now) const {
  constexpr double kRounding = 1e-6;  // bytes; a wait is whole nanoseconds
  const double missing = static_cast<double>(std::min(bytes, config_.burst_bytes)) - level(now);
  if (missing <= kRounding) return Duration::zero();
  const Duration owed = now < updated_ ? updated_ - now : Duration::zero();
  return owed + Duration{static_cast<std::int64_t>(std::ceil(missing * 8.0e9 / config_.rate_bit_s))};
}

}  // namespace fleetmap::bus
