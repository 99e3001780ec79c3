#include "fleetmap/sensor/clock_offsets.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

namespace fleetmap::sensor {
namespace {

constexpr Duration kWindow = std::chrono::seconds(5);
/// Samples of so long, and so many, tell a sensor's lag; a GPS may give one a second.
constexpr Duration kLearning = std::chrono::milliseconds(1500);
/// A step is believed after so many late samples in a row over so long: what a program that was stopped finds
/// waiting comes all at once.
constexpr int kStepSamples = 3;
constexpr Duration kStepTime = std::chrono::milliseconds(150);
/// When a clock is set that all sensors share, they show it one after the other.
constexpr Duration kTellAfter = std::chrono::seconds(3);
/// s: sensors whose lags differ by less share a clock.
constexpr double kTogether = 0.5;
/// s: a correction that was begun stays until the clock is nearer than this.
constexpr double kStillWrong = 0.5;
/// A correction follows a clock that drifts: beyond this many s of difference, by so much in a second.
constexpr double kDeadBand = 0.02, kSlew = 0.01;

}  // namespace

const char* to_string(Source source) {
  constexpr std::array<const char*, kSources> kNames{"lidar", "imu", "gps", "wheels"};
  return kNames[static_cast<std::size_t>(source)];
}

bool ClockOffsets::stepped(Track& track, double lag, Stamp arrival) {
  if (!track.known || lag < track.lag() + kWrong) {
    track.late = 0;
    track.least_late = kNone;
    return false;
  }
  if (track.late++ == 0) track.late_since = arrival;
  track.least_late = std::min(track.least_late, lag);
  return track.late >= kStepSamples && arrival - *track.late_since >= kStepTime;
}

void ClockOffsets::add(Source source, Stamp stamp, Stamp arrival) {
  Track& track = tracks_[static_cast<std::size_t>(source)];
  const double lag = to_seconds(arrival - stamp);
  if (!track.begun) track.begun = track.window_begun = arrival;
  if (stepped(track, lag, arrival)) {
    track.before = track.least_late;
    track.now = lag;
    track.late = 0;
    track.window_begun = arrival;
  } else if (arrival - track.window_begun >= kWindow) {
    track.before = track.now;
    track.now = lag;
    track.window_begun = arrival;
  } else {
    track.now = std::min(track.now, lag);
  }
  track.known = track.known || arrival - *track.begun >= kLearning;
  const Stamp since = std::min(last_arrival_.value_or(arrival), arrival);
  last_arrival_ = arrival;
  judge(since, arrival);
}

std::optional<double> ClockOffsets::right_lag() const {
  std::vector<double> lags;
  for (const Track& track : tracks_) {
    if (track.known) lags.push_back(track.lag());
  }
  if (lags.size() < 2) return std::nullopt;
  std::optional<double> right;
  std::ptrdiff_t most = 0;
  for (const double lag : lags) {
    const auto together =
        std::ranges::count_if(lags, [lag](double other) { return std::abs(other - lag) < kTogether; });
    if (together > most || (together == most && std::abs(lag) < std::abs(*right))) {
      most = together;
      right = lag;
    }
  }
  return right;
}

std::optional<double> ClockOffsets::behind(Source source) const {
  const Track& track = tracks_[static_cast<std::size_t>(source)];
  const auto right = right_lag();
  if (!right || !track.known) return std::nullopt;
  return track.lag() - *right;
}

void ClockOffsets::judge(Stamp since, Stamp arrival) {
  const auto right = right_lag();
  if (!right) return;
  for (std::size_t k = 0; k < kSources; ++k) {
    Track& track = tracks_[k];
    if (!track.known) continue;
    const double behind = track.lag() - *right;
    const double least = track.correction == 0.0 ? kWrong : kStillWrong;
    const double wanted = std::abs(behind) > least ? behind : 0.0;
    const double change = wanted - track.correction;
    if (std::abs(change) > kWrong || (wanted == 0.0) != (track.correction == 0.0)) {
      track.correction = wanted;
    } else if (std::abs(change) > kDeadBand) {
      const double most = kSlew * to_seconds(arrival - since);
      track.correction += std::clamp(change, -most, most);
    }
    tell(static_cast<Source>(k), behind, arrival);
  }
}

void ClockOffsets::tell(Source source, double behind, Stamp arrival) {
  Track& track = tracks_[static_cast<std::size_t>(source)];
  const bool is_off = std::abs(behind) > kTold;
  if (is_off ? std::abs(behind - track.told) < kTold : track.told == 0.0) return track.untold_since.reset();
  if (!track.untold_since) track.untold_since = arrival;
  if (arrival - *track.untold_since < kTellAfter) return;
  track.untold_since.reset();
  track.told = is_off ? behind : 0.0;
  std::ostringstream text;
  text.precision(2);
  text << std::fixed << to_string(source);
  if (!is_off) {
    text << ": stamps agree with those of the other sensors again";
  } else {
    text << ": stamps are " << std::abs(behind) << " s " << (behind > 0.0 ? "behind" : "ahead of")
         << " those of the other sensors; "
         << (track.correction != 0.0 ? "they are corrected by that, to about 0.1 s: set the sensor's clock "
                                       "(PTP, GPS or the driver's "
                                       "system time)"
                                     : "if that is no slow driver, set the sensor's clock");
  }
  news_.push_back(text.str());
}

bool ClockOffsets::unclear(Source source) const {
  const Track& track = tracks_[static_cast<std::size_t>(source)];
  if (!track.begun || track.known) return false;
  return std::ranges::any_of(tracks_, [&](const Track& other) {
    return other.begun && std::abs(other.lag() - track.lag()) > kWrong;
  });
}

Duration ClockOffsets::correction(Source source) const {
  return from_seconds(tracks_[static_cast<std::size_t>(source)].correction);
}

std::vector<std::string> ClockOffsets::take_news() { return std::exchange(news_, {}); }

}  // namespace fleetmap::sensor
