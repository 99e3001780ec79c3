#include "options.hpp"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <optional>

#include "fleetmap/core/paths.hpp"

namespace fleetmap::apps {
namespace {

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set from a signal handler");

/// Decimal digits alone; a zero in front would be read as octal.
std::optional<std::uint64_t> whole(const std::string& text) {
  std::uint64_t value = 0;
  const char* end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stopped != end || (text.size() > 1 && text[0] == '0')) return std::nullopt;
  return value;
}

std::optional<double> finite(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

Result<std::vector<config::Override>> parse_overrides(const std::vector<std::string>& texts) {
  std::vector<config::Override> overrides;
  for (const std::string& text : texts) {
    auto parsed = config::parse_override(text);
    if (!parsed) return tl::unexpected(parsed.error());
    overrides.push_back(std::move(*parsed));
  }
  return overrides;
}

CLI::Validator whole_number(std::uint64_t min, std::uint64_t max) {
  const bool bounded = max < std::numeric_limits<std::uint64_t>::max();
  const std::string range = bounded ? "from " + std::to_string(min) + " to " + std::to_string(max)
                                    : "of at least " + std::to_string(min);
  const auto check = [=](const std::string& text) {
    const auto value = whole(text);
    if (value && *value >= min && *value <= max) return std::string();
    return "must be a whole number " + range + ", is " + text;
  };
  return {check, "", "whole number"};
}

CLI::Validator positive_number() {
  const auto check = [](const std::string& text) {
    const auto value = finite(text);
    return value && *value > 0.0 ? std::string() : "must be a number greater than 0, is " + text;
  };
  return {check, "", "positive number"};
}

CLI::Validator non_negative_number() {
  const auto check = [](const std::string& text) {
    const auto value = finite(text);
    return value && *value >= 0.0 ? std::string() : "must be a number of at least 0, is " + text;
  };
  return {check, "", "non-negative number"};
}

CLI::Validator some_path() {
  const auto check = [](const std::string& text) {
    return text.empty() ? std::string("is empty; give a path (is a variable unset?)") : std::string();
  };
  return {check, "", "path"};
}

Status check_writable(const std::filesystem::path& directory) {
  if (!is_folder(directory)) return failure(directory.string() + ": is no folder");
  if (::access(directory.c_str(), W_OK | X_OK) != 0)
    return failure(directory.string() +
                   ": cannot be written to; check its permissions or give another folder");
  return {};
}

Status make_writable(const std::filesystem::path& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) return failure(directory.string() + ": cannot be made: " + error.message());
  return check_writable(directory);
}

const std::atomic<bool>& stop_on_signals() {
  for (const int signal : {SIGINT, SIGTERM}) {
    std::signal(signal, [](int) { stop_requested = true; });
  }
  return stop_requested;
}

}  // namespace fleetmap::apps
