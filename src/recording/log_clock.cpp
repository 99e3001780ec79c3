#include "fleetmap/recording/log_clock.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <variant>
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

/// Times of one kind of sensor.
struct SensorTimes {
  Stamp first_stamp, last_stamp, first_recorded, last_recorded;
  Duration min_lag = Duration::max();
};

std::optional<double> rate_of(const SensorTimes& times) {
  const Duration span = times.last_stamp - times.first_stamp;
  if (span < kMinSpan) return std::nullopt;
  return to_seconds(times.last_recorded - times.first_recorded) / to_seconds(span);
}

/// Two sensors that disagree: the one nearer to the times of recording counts.
Duration common_lag(std::vector<Duration> lags) {
  std::ranges::sort(lags, {}, [](Duration lag) { return lag < Duration::zero() ? -lag : lag; });
  return lags[(lags.size() - 1) / 2];
}

LogClock clock_of(const std::vector<SensorTimes>& sensors) {
  std::vector<double> rates;
  std::vector<Duration> lags;
  for (const SensorTimes& times : sensors) {
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

Result<LogClock> find_log_clock(const std::filesystem::path& recording, const ReaderConfig& config) {
  auto reader = open(recording, config, ScanContent::kStampOnly);
  if (!reader) return tl::unexpected(reader.error());
  std::array<std::optional<SensorTimes>, std::variant_size_v<Sample>> times;
  std::optional<Stamp> begun;
  for (std::size_t samples = 0; samples < kMaxSamples; ++samples) {
    const auto sample = (*reader)->next();
    if (!sample || !*sample) break;  // the player reports the reason
    const auto recorded = (*reader)->recorded();
    if (!recorded) return LogClock{};
    if (!begun) begun = recorded;
    const Stamp stamp = stamp_of(**sample);
    std::optional<SensorTimes>& sensor = times[(*sample)->index()];
    if (!sensor) sensor = SensorTimes{stamp, stamp, *recorded, *recorded};
    sensor->last_stamp = stamp;
    sensor->last_recorded = *recorded;
    sensor->min_lag = std::min(sensor->min_lag, *recorded - stamp);
    if (*recorded - *begun > kExamined) break;
  }
  std::vector<SensorTimes> sensors;
  for (const auto& sensor : times) {
    if (sensor) sensors.push_back(*sensor);
  }
  return sensors.empty() ? LogClock{} : clock_of(sensors);
}

}  // namespace fleetmap::recording
