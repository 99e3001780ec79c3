#include "sweep_inputs.hpp"

#include <chrono>
#include <utility>
#include <variant>

namespace fleetmap::apps {
namespace {

/// A sensor that was heard may lag behind so far; one that lags more has stopped.
constexpr Duration kLongestLag = std::chrono::milliseconds(250);
/// Beyond this the LiDAR is silent, and the samples are of no use.
constexpr std::size_t kMaxSamplesBetweenScans = 4000;

template <class T>
void keep(std::vector<T>& samples, const T& sample) {
  if (samples.size() >= kMaxSamplesBetweenScans)
    samples.erase(samples.begin(), samples.begin() + kMaxSamplesBetweenScans / 2);
  samples.push_back(sample);
}

}  // namespace

void SweepInputs::add(recording::Sample sample) {
  if (const auto* imu = std::get_if<sensor::Imu>(&sample)) {
    keep(imu_, *imu);
    last_imu_ = imu->stamp;
  } else if (const auto* wheel = std::get_if<sensor::Wheel>(&sample)) {
    keep(wheels_, *wheel);
    last_wheel_ = wheel->stamp;
  } else if (auto* scan = std::get_if<sensor::Scan>(&sample)) {
    const Stamp end = sensor::end_of(*scan);
    if (waiting_.size() == capacity_) {
      waiting_.pop_front();
      ++dropped_;
    }
    waiting_.push_back({std::move(*scan), end});
  }
}

bool SweepInputs::due() const {
  const Waiting& first = waiting_.front();
  const bool covered = (!last_imu_ || *last_imu_ >= first.end) && (!last_wheel_ || *last_wheel_ >= first.end);
  return covered || waiting_.size() == capacity_ ||
         waiting_.back().scan.stamp - first.scan.stamp > kLongestLag;
}

std::optional<SweepInput> SweepInputs::take_due() {
  if (waiting_.empty() || !due()) return std::nullopt;
  return take();
}

std::optional<SweepInput> SweepInputs::take() {
  if (waiting_.empty()) return std::nullopt;
  sensor::Scan scan = std::move(waiting_.front().scan);
  waiting_.pop_front();
  return SweepInput{std::move(scan), std::exchange(imu_, {}), std::exchange(wheels_, {})};
}

}  // namespace fleetmap::apps
