#include "fleetmap/sensor/gpsd_fixes.hpp"

#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "fleetmap/core/utc.hpp"

namespace fleetmap::sensor {
namespace {

using nlohmann::json;

/// gpsd's own limit, GPS_JSON_RESPONSE_MAX, is 10,240.
constexpr std::size_t kMaxLine = 65'536;
constexpr int kFix3d = 3;
constexpr std::size_t kMaxErrors = 10;

std::optional<double> number_of(const json& report, const char* key) {
  const auto found = report.find(key);
  return found != report.end() && found->is_number() ? std::optional(found->get<double>()) : std::nullopt;
}

std::string text_of(const json& report, const char* key) {
  const auto found = report.find(key);
  return found != report.end() && found->is_string() ? found->get<std::string>() : std::string();
}

Fix fix_of(const json& report, Stamp stamp, std::uint64_t& above_sea_level) {
  Fix fix;
  fix.stamp = stamp;
  const auto latitude = number_of(report, "lat"), longitude = number_of(report, "lon");
  const auto ellipsoid = number_of(report, "altHAE"), sea = number_of(report, "altMSL"),
             older = number_of(report, "alt");
  const std::optional<double> altitude = ellipsoid ? ellipsoid : sea ? sea : older;
  if (latitude && longitude)
    fix.position = geo_point_from_degrees(*latitude, *longitude, altitude.value_or(0.0));
  fix.valid = number_of(report, "mode").value_or(0.0) >= kFix3d && latitude && longitude && altitude &&
              is_valid(fix.position);
  fix.above_sea_level = altitude && !ellipsoid;
  if (fix.valid && fix.above_sea_level) ++above_sea_level;
  const auto east = number_of(report, "epx"), north = number_of(report, "epy"), up = number_of(report, "epv");
  if (east && north && up) fix.covariance.diagonal() << *east * *east, *north * *north, *up * *up;
  return fix;
}

}  // namespace

DeviceSamples GpsdFixes::add(ByteView bytes) {
  DeviceSamples samples;
  for (const std::uint8_t byte : bytes) {
    if (byte == '\n') {
      if (!too_long_) read(line_, samples);
      line_.clear();
      too_long_ = false;
    } else if (line_.size() < kMaxLine) {
      line_.push_back(static_cast<char>(byte));
    } else if (!std::exchange(too_long_, true)) {
      ++counters_.malformed;
    }
  }
  return samples;
}

void GpsdFixes::begin() {
  line_.clear();
  too_long_ = false;
}

void GpsdFixes::read(const std::string& line, DeviceSamples& samples) {
  const json report = json::parse(line, nullptr, false);
  const std::string kind = report.is_object() ? text_of(report, "class") : std::string();
  if (kind.empty()) return void(++counters_.malformed);
  ++counters_.reports;
  if (kind == "ERROR" && errors_.size() < kMaxErrors) errors_.push_back(text_of(report, "message"));
  if (kind != "TPV") return;
  const auto stamp = from_utc(text_of(report, "time"));
  if (!stamp) return void(++counters_.without_time);
  samples.fixes.push_back(fix_of(report, *stamp, counters_.above_sea_level));
}

std::vector<std::string> GpsdFixes::take_errors() { return std::exchange(errors_, {}); }

}  // namespace fleetmap::sensor
