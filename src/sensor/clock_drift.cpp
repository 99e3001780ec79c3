#include "fleetmap/sensor/clock_drift.hpp"

#include <algorithm>
#include <cmath>

namespace fleetmap::sensor {

void ClockDrift::reset() { *this = {}; }

bool ClockDrift::add(Stamp arrival, double lag) {
  if (!begun_) begun_ = bucket_begun_ = arrival;
  bool completed = false;
  if (arrival - *bucket_begun_ >= kBucket) {
    if (!first_) first_ = min_;
    buckets_.push_back({min_time_, min_ - *first_});
    if (buckets_.size() > kMax) buckets_.pop_front();
    bucket_begun_ = arrival;
    min_ = std::numeric_limits<double>::infinity();
    completed = true;
  }
  if (lag < min_) {
    min_ = lag;
    min_time_ = to_seconds(arrival - *begun_);
  }
  return completed;
}

std::optional<ClockDrift::Line> ClockDrift::line() const {
  if (buckets_.size() < kMinBuckets) return std::nullopt;
  const auto n = static_cast<double>(buckets_.size());
  double mean_time = 0.0, mean_lag = 0.0;
  for (const Bucket& bucket : buckets_) {
    mean_time += bucket.time / n;
    mean_lag += bucket.lag / n;
  }
  double tt = 0.0, tl = 0.0, ll = 0.0;
  for (const Bucket& bucket : buckets_) {
    const double t = bucket.time - mean_time, l = bucket.lag - mean_lag;
    tt += t * t;
    tl += t * l;
    ll += l * l;
  }
  if (!(tt > 0.0)) return std::nullopt;
  const double slope = tl / tt;
  const double residual = std::max(0.0, ll - slope * tl) / (n - 2.0);
  const double span = buckets_.back().time - buckets_.front().time;
  return Line{slope, std::sqrt(residual / tt), std::sqrt(residual), span};
}

}  // namespace fleetmap::sensor
