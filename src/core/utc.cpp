#include "fleetmap/core/utc.hpp"

#include <array>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <utility>

namespace fleetmap {
namespace {

/// Takes two or four digits and the `behind` that follows off the front.
std::optional<int> take_number(std::string_view& text, std::size_t digits, std::string_view behind) {
  int value = 0;
  if (text.size() < digits + behind.size() || text.substr(digits, behind.size()) != behind || text[0] == '-')
    return std::nullopt;
  if (std::from_chars(text.data(), text.data() + digits, value).ptr != text.data() + digits)
    return std::nullopt;
  text.remove_prefix(digits + behind.size());
  return value;
}

}  // namespace

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

std::optional<Stamp> from_utc(std::string_view text) {
  constexpr std::array<std::pair<std::size_t, std::string_view>, 6> kParts = {
      {{4, "-"}, {2, "-"}, {2, "T"}, {2, ":"}, {2, ":"}, {2, ""}}};
  std::array<int, kParts.size()> parts{};
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const auto number = take_number(text, kParts[k].first, kParts[k].second);
    if (!number) return std::nullopt;
    parts[k] = *number;
  }
  double decimals = 0.0;
  if (text.starts_with('.')) {
    const auto read =
        std::from_chars(text.data(), text.data() + text.size(), decimals, std::chars_format::fixed);
    if (read.ec != std::errc{}) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(read.ptr - text.data()));
  }
  const auto [year, month, day, hour, minute, second] = parts;
  const std::chrono::year_month_day date{std::chrono::year(year),
                                         std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  const bool sound = date.ok() && year >= 1970 && year <= 2261 && hour < 24 && minute < 60 && second <= 60;
  if (text != "Z" || !sound) return std::nullopt;
  return Stamp(std::chrono::sys_days(date)) + std::chrono::hours(hour) + std::chrono::minutes(minute) +
         std::chrono::seconds(second) + from_seconds(decimals);
}

}  // namespace fleetmap
