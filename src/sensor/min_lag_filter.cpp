#include "fleetmap/sensor/min_lag_filter.hpp"

#include <algorithm>

namespace fleetmap::sensor {
namespace {

constexpr Duration kBucket = std::chrono::seconds(5), kWindow = std::chrono::seconds(30);
constexpr int kStepSamples = 3;
/// Samples that waited while the program was stopped arrive all at once and prove nothing.
constexpr Duration kStepTime = std::chrono::milliseconds(150);
/// Samples that overtake each other are not set back.
constexpr Duration kSetBack = std::chrono::milliseconds(500);
/// A queue that is being emptied has ever shorter lags, a clock the same.
constexpr Duration kSteadyTime = std::chrono::milliseconds(1500);
constexpr double kSteady = 0.5;  // s

}  // namespace

bool MinLagFilter::add(Stamp stamp, Stamp arrival) {
  const double lag = to_seconds(arrival - stamp);
  const bool step = stepped(stamp, arrival, lag);
  if (step) {
    const double min = late_->min;
    *this = {};
    insert(arrival, min);
  } else {
    insert(arrival, lag);
  }
  newest_ = std::max(newest_, stamp);
  return step;
}

bool MinLagFilter::stepped(Stamp stamp, Stamp arrival, double lag) {
  if (empty() || lag <= min_ + kLate) {
    late_.reset();
    return false;
  }
  if (!late_) late_ = LateRun{.begun = arrival, .min = lag, .max = lag};
  LateRun& run = *late_;
  ++run.samples;
  run.min = std::min(run.min, lag);
  run.max = std::max(run.max, lag);
  run.set_back = run.set_back && newest_ - stamp > kSetBack;
  if (run.samples < kStepSamples) return false;
  if (run.set_back) return arrival - run.begun >= kStepTime;
  return run.min > min_ + kMaxLateness && run.max - run.min < kSteady && arrival - run.begun >= kSteadyTime;
}

void MinLagFilter::insert(Stamp arrival, double lag) {
  if (empty() || arrival - buckets_.back().begun >= kBucket) {
    buckets_.push_back({arrival, lag});
    while (arrival - buckets_.front().begun >= kWindow) buckets_.pop_front();
  }
  buckets_.back().min = std::min(buckets_.back().min, lag);
  min_ = kNone;
  for (const Bucket& bucket : buckets_) min_ = std::min(min_, bucket.min);
}

}  // namespace fleetmap::sensor
