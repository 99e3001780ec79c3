#include "fleetmap/recording/log_clock.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace fleetmap::recording {
namespace {

constexpr Duration kExamined = std::chrono::seconds(20);
constexpr std::size_t kMaxSamples = 20'000;
/// A sensor's rate is known from so much of its own time.
constexpr Duration kMinSpan = std::chrono::seconds(2);
/// Clocks drift by less; programs that played or simulated at another rate miss it by more.
constexpr double kMaxRateError = 0.05;
/// Lags below this are those of drivers and of single sensors' clocks.
constexpr Duration kWrittenLater = std::chrono::minutes(1);

std::optional<double> rate_of(const LogClockFinder::Times& times) {
  const Duration span = times.last_stamp - times.first_stamp;
  if (span < kMinSpan) return std::nullopt;
  return to_seconds(times.last_recorded - times.first_recorded) / to_seconds(span);
}

/// Two sensors that disagree: the one nearer to the times of recording counts.
Duration common_lag(std::vector<Duration> lags) {
  std::ranges::sort(lags, {}, [](Duration lag) { return lag < Duration::zero() ? -lag : lag; });
  return lags[(lags.size() - 1) / 2];
}

LogClock clock_of(const std::vector<LogClockFinder::Times>& sensors) {
  std::vector<double> rates;
  std::vector<Duration> lags;
  for (const LogClockFinder::Times& times : sensors) {
    if (const auto rate = rate_of(times)) rates.push_back(*rate);
    lags.push_back(times.min_lag);
  }
  LogClock clock;
  if (!rates.empty()) {
    std::ranges::sort(rates, {}, [](double rate) { return std::abs(rate - 1.0); });
    clock.usable = std::abs(rates[(rates.size() - 1) / 2] - 1.0) <= kMaxRateError;
  }
  const Duration lag = common_lag(lags);
  if (lag > kWrittenLater || lag < -kWrittenLater) clock.shift = -lag;
  return clock;
}

}  // namespace

bool LogClockFinder::add(const Sample& sample, Stamp recorded) {
  if (!begun_) begun_ = recorded;
  if (++samples_ > kMaxSamples || recorded - *begun_ > kExamined) return false;
  const Stamp stamp = stamp_of(sample);
  std::optional<Times>& sensor = times_[sample.index()];
  if (!sensor) sensor = Times{stamp, stamp, recorded, recorded};
  sensor->last_stamp = stamp;
  sensor->last_recorded = recorded;
  sensor->min_lag = std::min(sensor->min_lag, recorded - stamp);
  return true;
}

LogClock LogClockFinder::clock() const {
  std::vector<Times> sensors;
  for (const auto& sensor : times_) {
    if (sensor) sensors.push_back(*sensor);
  }
  return sensors.empty() ? LogClock{} : clock_of(sensors);
}

}  // namespace fleetmap::recording
