#include "fleetmap/sensor/clock_offsets.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <utility>

#include "time_scales.hpp"

namespace fleetmap::sensor {
namespace {

/// A sensor's lag is determined from samples over this time, and this many; a GPS may send one a second.
constexpr Duration kLearning = std::chrono::milliseconds(1500);
/// A computer that is starting up is busy; samples that are still late after this have another clock.
constexpr Duration kProving = std::chrono::seconds(10);
/// The second sensor follows the first within this.
constexpr Duration kAlone = std::chrono::milliseconds(300);
/// When a clock is set that all sensors share, they show it one after the other.
constexpr Duration kReportAfter = std::chrono::seconds(4);
/// s: sensors whose lags differ by less share a clock.
constexpr double kTogether = 0.5;
/// s: a correction that was begun stays until the clock is nearer than this.
constexpr double kStillWrong = 0.5;
/// A correction follows a clock that drifts: beyond this many s of difference, by so much in a second.
constexpr double kDeadBand = 0.02, kSlew = 0.01;
/// s/s: clocks whose rates differ by less are taken for one.
constexpr double kSameRate = 20e-6;
/// A drift is one beyond this rate and so many standard deviations, when it has come to so many s: a computer
/// that becomes busier delays samples by less.
constexpr double kDrift = 30e-6, kCertain = 5.0, kVisible = 0.05;
constexpr double kOtherDrift = 30e-6;  // s/s, a change of the drift that is reported again
/// ... and to so many times what the lags scatter about the line, which a step does not.
constexpr double kStraight = 10.0;

constexpr double kMillion = 1e6;

}  // namespace

const char* to_string(Source source) {
  constexpr std::array<const char*, kSources> kNames{"lidar", "imu", "gps", "wheels"};
  return kNames[static_cast<std::size_t>(source)];
}

void ClockOffsets::add(Source source, Stamp stamp, Stamp arrival) {
  Track& own = tracks_[static_cast<std::size_t>(source)];
  if (!own.begun) own.begun = arrival;
  own.last_stamp = stamp;
  if (own.envelope.add(stamp, arrival)) {
    own.forget_drift();
    own.certain = true;
  }
  const Duration heard = arrival - *own.begun;
  if (!own.known) own.certain = own.known = heard >= kProving || (heard >= kLearning && !may_be_late(own));
  const Duration since = std::max(Duration::zero(), arrival - last_arrival_.value_or(arrival));
  last_arrival_ = arrival;
  if (own.drift.add(arrival, to_seconds(arrival - stamp))) {
    if (!own.behind_at_first && !alone()) own.behind_at_first = behind(source);
    find_drifts();
  }
  if (alone() && own.known) return report_offset(source, own.lag(), arrival);
  const auto right = right_lag();
  if (!right) return;
  for (std::size_t k = 0; k < kSources; ++k) {
    if (tracks_[k].known) check(static_cast<Source>(k), *right, since, arrival);
  }
}

bool ClockOffsets::alone() const {
  return std::ranges::count_if(tracks_, [](const Track& track) { return track.begun.has_value(); }) == 1;
}

std::size_t ClockOffsets::sharing(double lag) const {
  return static_cast<std::size_t>(std::ranges::count_if(
      tracks_, [lag](const Track& other) { return other.begun && std::abs(other.lag() - lag) < kTogether; }));
}

bool ClockOffsets::may_be_late(const Track& track) const {
  return std::ranges::any_of(tracks_, [&](const Track& other) {
    const double late = track.lag() - other.lag();
    return other.begun && late > kWrong && late < MinLagFilter::kMaxLateness &&
           sharing(other.lag()) >= sharing(track.lag());
  });
}

std::optional<double> ClockOffsets::right_lag() const {
  std::vector<double> lags;
  std::size_t known = 0, learning = 0;
  for (const Track& track : tracks_) {
    known += track.known;
    learning += track.begun && !track.known;
    if (track.known && !track.slow) lags.push_back(track.lag());
  }
  if (known < 2 || lags.empty()) return std::nullopt;
  std::ranges::sort(lags);
  std::optional<double> right;
  std::ptrdiff_t max_count = 0;
  bool tie = false;
  for (const double lag : lags) {
    // The least of a clock's lags is the one that drivers added least to.
    const auto together =
        std::ranges::count_if(lags, [lag](double other) { return other >= lag && other - lag < kTogether; });
    tie = together == max_count || (tie && together < max_count);
    if (together > max_count || (tie && together == max_count && std::abs(lag) < std::abs(*right)))
      right = lag;
    max_count = std::max(max_count, together);
  }
  // Those that are heard since a moment decide soon.
  return tie && learning > 0 ? std::nullopt : right;
}

std::optional<double> ClockOffsets::behind(Source source) const {
  const auto right = alone() ? std::optional(0.0) : right_lag();
  if (!right || !track(source).known) return std::nullopt;
  return track(source).lag() - *right;
}

std::optional<double> ClockOffsets::slow_ppm(Source source) const {
  const auto& slow = track(source).slow;
  return slow ? std::optional(kMillion * *slow) : std::nullopt;
}

std::optional<ClockDrift::Line> ClockOffsets::right_rate() const {
  std::vector<ClockDrift::Line> lines;
  for (const Track& track : tracks_) {
    if (const auto line = track.drift.line(); line && track.known) lines.push_back(*line);
  }
  if (lines.size() < 2) return std::nullopt;
  std::optional<ClockDrift::Line> right;
  std::ptrdiff_t max_count = 0;
  for (const ClockDrift::Line& line : lines) {
    const auto together = std::ranges::count_if(
        lines, [&](const auto& other) { return std::abs(other.slope - line.slope) < kSameRate; });
    if (together > max_count || (together == max_count && std::abs(line.slope) < std::abs(right->slope))) {
      max_count = together;
      right = line;
    }
  }
  return right;
}

void ClockOffsets::find_drifts() {
  const auto right = right_rate();
  for (std::size_t k = 0; k < kSources; ++k) {
    Track& own = tracks_[k];
    const auto line = own.drift.line();
    if (!right || !line || !own.behind_at_first) continue;
    const double slow = line->slope - right->slope;
    const bool certain = std::abs(slow) > kDrift &&
                         std::abs(slow) > kCertain * std::hypot(line->deviation, right->deviation) &&
                         std::abs(slow) * line->span > std::max(kVisible, kStraight * line->scatter);
    own.slow = certain ? std::optional(slow) : std::nullopt;
    // A drift on the edge of what is certain comes and goes.
    if (!certain || (own.reported_slow && std::abs(slow - *own.reported_slow) < kOtherDrift)) continue;
    own.reported_slow = slow;
    report_drift(static_cast<Source>(k), slow);
  }
}

void ClockOffsets::check(Source source, double right, Duration since, Stamp arrival) {
  Track& own = tracks_[static_cast<std::size_t>(source)];
  const double behind = own.lag() - right;
  const double drifted = own.slow ? behind - *own.behind_at_first : 0.0;
  const double offset = behind - drifted;
  const bool was_off = std::exchange(own.is_off, std::abs(offset) > (own.is_off ? kStillWrong : kWrong));
  const double wanted = (own.is_off ? nearest_of_time_scales(offset) : 0.0) + drifted;
  const double change = wanted - own.correction;
  const bool leaps = std::abs(change) > kWrong;
  if (!leaps) own.leap_begun.reset();
  if (leaps && !own.leap_begun) own.leap_begun = arrival;
  // Samples that were all late come on time again one sensor after the other.
  if (leaps && !own.certain && arrival - *own.leap_begun < kLearning) {
    own.is_off = was_off;
    return;
  }
  own.certain = false;
  own.leap_begun.reset();
  if (leaps || was_off != own.is_off) {
    own.correction = wanted;
    if (leaps) own.forget_drift();
  } else if (std::abs(change) > kDeadBand) {
    const double max_change = kSlew * to_seconds(since);
    own.correction += std::clamp(change, -max_change, max_change);
  }
  report_offset(source, offset, arrival);
}

void ClockOffsets::report_offset(Source source, double offset, Stamp arrival) {
  Track& own = tracks_[static_cast<std::size_t>(source)];
  const bool is_off = std::abs(offset) > kReportedOffset;
  if (is_off ? std::abs(offset - own.reported) < kReportedOffset : own.reported == 0.0)
    return own.unreported_since.reset();
  if (!own.unreported_since) own.unreported_since = arrival;
  // An uncorrected offset may be that of a busy computer's late samples.
  if (arrival - *own.unreported_since < (own.is_off || !is_off ? kReportAfter : kProving)) return;
  own.unreported_since.reset();
  own.reported = is_off ? offset : 0.0;
  news_.push_back(offset_report(source, offset, is_off));
}

ClockNews ClockOffsets::offset_report(Source source, double offset, bool is_off) const {
  const Track& own = track(source);
  const std::string reference = alone() ? "the computer's clock" : "those of the other sensors";
  std::ostringstream text;
  text << std::fixed << std::setprecision(2) << to_string(source) << ": stamps ";
  if (!is_off) {
    text << "agree with " << reference << " again";
    return {text.str(), true};
  }
  const double exact = own.is_off || alone() ? nearest_of_time_scales(offset) : offset;
  text << "are " << std::abs(exact) << " s " << (offset > 0.0 ? "behind " : "ahead of ") << reference
       << reason_of(offset, own.last_stamp) << "; ";
  if (alone()) {
    text << "they are used as they are, since no other sensor is there: set the clock that is wrong";
  } else if (own.is_off) {
    text << "they are corrected by that: set the sensor's clock (PTP, GPS or the driver's system time)";
  } else {
    text << "if that is no slow driver, set the sensor's clock";
  }
  return {text.str(), own.is_off && !alone() && is_of_time_scales(offset)};
}

void ClockOffsets::report_drift(Source source, double slow) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(0) << to_string(source) << ": its clock runs "
       << kMillion * std::abs(slow) << " ppm too " << (slow > 0.0 ? "slow" : "fast")
       << " against those of the other sensors; its stamps are corrected by that: synchronise it (PTP, GPS)";
  news_.push_back({text.str(), true});
}

bool ClockOffsets::unclear(Source source) const {
  const Track& own = track(source);
  if (!own.begun) return false;
  if (own.known && right_lag()) return own.leap_begun.has_value();
  if (alone()) return std::abs(own.lag()) > kWrong && *last_arrival_ - *own.begun < kAlone;
  return std::ranges::any_of(
      tracks_, [&](const Track& other) { return other.begun && std::abs(other.lag() - own.lag()) > kWrong; });
}

Duration ClockOffsets::correction(Source source) const { return from_seconds(track(source).correction); }

std::vector<ClockNews> ClockOffsets::take_news() { return std::exchange(news_, {}); }

std::vector<std::string> ClockOffsets::take_warnings() {
  std::vector<std::string> warnings;
  for (ClockNews& news : take_news()) warnings.push_back(std::move(news.text));
  return warnings;
}

}  // namespace fleetmap::sensor
