#include "fleetmap/sensor/stream_silence.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fleetmap::sensor {
namespace {

constexpr std::size_t kIntervalsOfRate = 10;
constexpr double kOwnShare = 0.5;  // of a gap, by the sensor's own stamps

std::string whole(double value) { return std::to_string(std::lround(value)); }

std::string from_to(double from, double to) {
  return "from " + whole(from) + " s to " + whole(to) + " s of the drive";
}

}  // namespace

SilenceRule fix_silence() {
  return {
      .sensor = "GPS: no fix",
      .found_after = 60.0,
      .found_in_one = 600.0,
      .remedy = "the place is that of the odometry there. No message came: check cable, driver and its topic",
      .empty_remedy =
          "messages came without a position (status -1); the place is that of the odometry there. Outages "
          "below trees and roofs are normal; else check "
          "the antenna and its cable"};
}

SilenceRule wheel_silence() {
  return {.sensor = "wheel odometry: no sample",
          .min_gap = 1.0,
          .min_moved = 1.0,
          .found_share = 0.1,
          .found_after = 3.0,
          .found_in_one = 30.0,
          .remedy = "the speed is not measured there. Check the cable, the driver and its topic",
          .empty_remedy = {}};
}

void StreamSilence::add(Stamp stamp) {
  // Work that was late and is made up for lets the drive go on by seconds between two samples.
  if (is_gap() && to_seconds(stamp - *last_) > kOwnShare * (now_ - last_at_)) {
    in_gaps_ += now_ - last_at_;
    ++gaps_;
    if (now_ - last_at_ > longest_.length()) longest_ = {last_at_, now_};
  }
  const std::optional<Stamp> before = std::exchange(last_, stamp);
  if (!first_at_) first_at_ = now_;
  last_at_ = now_;
  moved_ = 0.0;
  empty_ = 0;
  if (usual_interval_ || !before || stamp <= *before) return;
  first_intervals_.push_back(to_seconds(stamp - *before));
  if (first_intervals_.size() < kIntervalsOfRate) return;
  const auto half = first_intervals_.begin() + kIntervalsOfRate / 2;
  std::ranges::nth_element(first_intervals_, half);
  usual_interval_ = *half;
}

void StreamSilence::add_empty() {
  if (empty_++ == 0) first_empty_at_ = now_;
}

void StreamSilence::pass(double seconds, double moved) {
  now_ += seconds;
  moved_ += moved;
  check();
  check_empty();
}

bool StreamSilence::is_gap() const {
  return usual_interval_ && moved_ >= rule_.min_moved &&
         now_ - last_at_ >= std::max(rule_.min_gap, rule_.min_intervals * *usual_interval_);
}

void StreamSilence::check() {
  if (found_ || !is_gap()) return;
  const double open = now_ - last_at_, all = in_gaps_ + open, drive = now_ - *first_at_;
  const bool much = all >= rule_.found_after && all >= rule_.found_share * drive;
  if (!much && open < rule_.found_in_one) return;
  found_ = true;
  finding_ = rule_.sensor + " since " + whole(last_at_) + " s of the drive, for " + whole(open) + " s; " +
             whole(100.0 * all / drive) + " % of the time is in such gaps: " + reason();
}

/// A sensor may have said nothing yet, although its messages come.
void StreamSilence::check_empty() {
  if (empty_found_ || first_at_ || empty_ == 0 || now_ - first_empty_at_ < rule_.found_after) return;
  empty_found_ = true;
  finding_ = rule_.sensor + " in the first " + whole(now_ - first_empty_at_) + " s: " + reason();
}

std::string StreamSilence::reason() const {
  if (empty_ == 0) return rule_.remedy;
  return std::to_string(empty_) + " " + rule_.empty_remedy;
}

std::optional<std::string> StreamSilence::take_finding() { return std::exchange(finding_, std::nullopt); }

std::optional<std::string> StreamSilence::note() const {
  const bool open = is_gap();
  const Gap last{last_at_, now_};
  const std::size_t gaps = gaps_ + (open ? 1 : 0);
  if (gaps == 0) return std::nullopt;
  const Gap& longest = open && last.length() > longest_.length() ? last : longest_;
  const std::string where =
      from_to(longest.from, longest.to) + (open && &longest == &last ? ", its end" : "");
  if (gaps == 1) return rule_.sensor + " " + where;
  return rule_.sensor + " in " + std::to_string(gaps) + " gaps, together " +
         whole(in_gaps_ + (open ? last.length() : 0.0)) + " s; the longest is " + where;
}

}  // namespace fleetmap::sensor
