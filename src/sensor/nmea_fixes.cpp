#include "fleetmap/sensor/nmea_fixes.hpp"

#include <utility>
#include <variant>

namespace fleetmap::sensor {
namespace {

constexpr Duration kDay = std::chrono::hours(24);
/// A receiver that sent GST within this sends it with each fix.
constexpr Duration kGstExpected = std::chrono::seconds(5);

/// The moment nearest to another at a time of the day.
Stamp nearest_at_time_of_day(Stamp moment, Duration time) {
  Duration ahead = (time - moment.time_since_epoch()) % kDay;
  if (ahead > kDay / 2) ahead -= kDay;
  if (ahead <= -kDay / 2) ahead += kDay;
  return moment + ahead;
}

}  // namespace

DeviceSamples NmeaFixes::add(ByteView bytes, Stamp arrival) {
  DeviceSamples samples;
  for (const std::string& text : sentences_.add(bytes)) {
    const auto sentence = read_nmea(text);
    if (!sentence) {
      sentences_.count_malformed();
      continue;
    }
    std::visit([&](const auto& read) { handle(read, arrival, samples); }, *sentence);
  }
  return samples;
}

Stamp NmeaFixes::utc(Duration time, Stamp arrival) const {
  return nearest_at_time_of_day(dated_ ? dated_->utc + (arrival - dated_->arrival) : arrival, time);
}

void NmeaFixes::handle(const NmeaRmc& rmc, Stamp arrival, DeviceSamples&) {
  if (rmc.valid) dated_ = Dated{rmc.midnight + rmc.time, arrival};
}

void NmeaFixes::handle(const NmeaGga& gga, Stamp arrival, DeviceSamples& samples) {
  finish(samples);
  Fix fix{.stamp = utc(gga.time, arrival), .position = gga.position};
  fix.valid = gga.quality > 0 && is_valid(gga.position);
  fix.above_sea_level = fix.valid && !gga.has_geoid;
  if (fix.above_sea_level) ++above_sea_level_;
  waiting_ = fix;
  waiting_time_ = gga.time;
  const bool expected = gst_arrival_ && arrival - *gst_arrival_ < kGstExpected;
  if (!expected || gst_->time == gga.time) finish(samples);
}

void NmeaFixes::handle(const NmeaGst& gst, Stamp arrival, DeviceSamples& samples) {
  gst_ = gst;
  gst_arrival_ = arrival;
  if (waiting_ && waiting_time_ == gst.time) finish(samples);
}

void NmeaFixes::finish(DeviceSamples& samples) {
  if (!waiting_) return;
  Fix fix = *std::exchange(waiting_, std::nullopt);
  if (gst_ && gst_->time == waiting_time_) {
    const auto square = [](double sigma) { return sigma * sigma; };
    fix.covariance.diagonal() << square(gst_->sigma_east), square(gst_->sigma_north), square(gst_->sigma_up);
  }
  samples.fixes.push_back(fix);
}

}  // namespace fleetmap::sensor
