#include "time_scales.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace fleetmap::sensor {
namespace {

struct Difference {
  double seconds;
  const char* meaning;
};
/// As they are since 2017; should a leap second come, its offset is measured like any other.
constexpr std::array kDifferences{Difference{18.0, "GPS time and UTC"}, Difference{37.0, "TAI and UTC"},
                                  Difference{19.0, "TAI and GPS time"}};
constexpr double kDrivers = 0.3;                  // s, that they take at most
constexpr double kQuarter = 900.0;                // s; time zones are multiples of it
constexpr double kLargestZone = 14.0 * 3600.0;    // s
constexpr double kYear = 365.25 * 86400.0;        // s
constexpr double kOldestReceiver = 10.0 * kYear;  // since 1970: GPS began in 1980

bool is_difference(const Difference& difference, double offset) {
  return std::abs(std::abs(offset) - difference.seconds) < kDrivers;
}

bool is_time_zone(double offset) {
  const double size = std::abs(offset);
  const double zone = kQuarter * std::round(size / kQuarter);
  return zone > 0.0 && zone <= kLargestZone && std::abs(size - zone) < kDrivers;
}

}  // namespace

double nearest_of_time_scales(double offset) {
  for (const Difference& difference : kDifferences) {
    if (is_difference(difference, offset)) return std::copysign(difference.seconds, offset);
  }
  return is_time_zone(offset) ? kQuarter * std::round(offset / kQuarter) : offset;
}

bool is_of_time_scales(double offset) {
  return is_time_zone(offset) || std::ranges::any_of(kDifferences, [&](const Difference& difference) {
           return is_difference(difference, offset);
         });
}

std::string reason_of(double offset, Stamp stamp) {
  for (const Difference& difference : kDifferences) {
    if (is_difference(difference, offset))
      return std::string(" (the difference of ") + difference.meaning + ")";
  }
  if (is_time_zone(offset)) return " (a time zone)";
  if (offset > kYear && to_seconds(stamp) < kOldestReceiver) return " (they count from the sensor's start)";
  return "";
}

}  // namespace fleetmap::sensor
