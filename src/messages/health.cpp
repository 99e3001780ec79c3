#include "fleetmap/messages/health.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fleetmap::messages {
namespace {

constexpr double kLargest = 39.0;  // 2^39 ms are 17 years

}  // namespace

std::int8_t clock_code(double behind) {
  if (!std::isfinite(behind)) return 0;
  const double steps = std::round(std::log2(std::max(1.0, 1e3 * std::abs(behind))));
  const auto code = static_cast<std::int8_t>(1.0 + std::min(steps, kLargest));
  return behind < 0.0 ? static_cast<std::int8_t>(-code) : code;
}

std::optional<double> seconds_behind(std::int8_t clock_code) {
  if (clock_code == 0) return std::nullopt;
  const double seconds = 1e-3 * std::exp2(std::abs(static_cast<double>(clock_code)) - 1.0);
  return clock_code < 0 ? -seconds : seconds;
}

std::vector<std::string> words_of(const Health& health) {
  constexpr std::pair<Health::Problem, const char*> kWords[] = {
      {Health::kDiskRefuses, "its disk refused writes"},
      {Health::kNoScan, "no scan comes from its LiDAR"},
      {Health::kNoPose, "its pose is not known"},
      {Health::kScansNotMatched, "its odometry could not match some scans"},
      {Health::kScansDropped, "its odometry dropped some scans, since it is too slow"}};
  std::vector<std::string> words;
  for (const auto& [problem, text] : kWords) {
    if ((health.problems & problem) != 0) words.emplace_back(text);
  }
  return words;
}

}  // namespace fleetmap::messages
