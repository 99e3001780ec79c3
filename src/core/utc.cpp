#include "fleetmap/core/utc.hpp"

#include <array>
#include <cstdint>
#include <cstdio>
#include <ctime>

namespace fleetmap {

std::string to_utc(Stamp stamp) {
  constexpr std::int64_t kSecond = 1'000'000'000, kMillisecond = 1'000'000;
  const std::int64_t ns = to_ns(stamp);
  const bool before_epoch = ns % kSecond < 0;
  const std::time_t seconds = ns / kSecond - (before_epoch ? 1 : 0);
  const std::int64_t fraction = ns % kSecond + (before_epoch ? kSecond : 0);
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  std::array<char, 80> text{};
  std::snprintf(text.data(), text.size(), "%04d-%02d-%02dT%02d:%02d:%02d.%03dZ", utc.tm_year + 1900,
                utc.tm_mon + 1, utc.tm_mday, utc.tm_hour, utc.tm_min, utc.tm_sec,
                static_cast<int>(fraction / kMillisecond));
  return text.data();
}

}  // namespace fleetmap
