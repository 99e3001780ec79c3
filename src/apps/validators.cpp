#include "validators.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>

#include "fleetmap/core/text_list.hpp"
#include "fleetmap/output/map_crs.hpp"

namespace fleetmap::apps {
namespace {

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

CLI::Validator number_within(double min, double max) {
  const auto check = [=](const std::string& text) {
    const auto value = finite(text);
    if (value && *value >= min && *value <= max) return std::string();
    std::ostringstream refusal;
    refusal << "must be a number from " << min << " to " << max << ", is " << text;
    return refusal.str();
  };
  return {check, "", "number within"};
}

CLI::Validator some_path() {
  const auto check = [](const std::string& text) {
    return text.empty() ? std::string("is empty; give a path (is a variable unset?)") : std::string();
  };
  return {check, "", "path"};
}

CLI::Validator file_ending(std::vector<std::string> extensions) {
  const auto check = [extensions = std::move(extensions)](const std::string& file) -> std::string {
    const std::string extension = std::filesystem::path(file).extension();
    if (std::ranges::find(extensions, extension) != extensions.end()) return {};
    std::string expected;
    for (const std::string& one : extensions) append_to_list(expected, one, " or ");
    return file + ": must end with " + expected;
  };
  return {check, "FILE"};
}

CLI::Validator reference_system() {
  const auto check = [](const std::string& text) {
    const auto crs = output::parse_crs(text);
    return crs ? std::string() : crs.error().message;
  };
  return {check, "CRS"};
}

}  // namespace fleetmap::apps
