#include "sensor_findings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

namespace fleetmap::apps {
namespace {

using sensor::Source;

constexpr std::size_t kMaxFindingLength = 120;
constexpr Duration kSendsAgain = std::chrono::seconds(5);

/// Words with which the findings of each sensor begin.
constexpr std::array<std::pair<std::string_view, Source>, 8> kBeginnings{
    {{"lidar: ", Source::kLidar},
     {"LiDAR: ", Source::kLidar},
     {"imu: ", Source::kImu},
     {"IMU: ", Source::kImu},
     {"gps: ", Source::kGps},
     {"GPS: ", Source::kGps},
     {"wheels: ", Source::kWheel},
     {"wheel odometry: ", Source::kWheel}}};

/// The finding up to its first clause that ends, or its first words.
std::string in_short(const std::string& finding) {
  std::string first = finding.substr(0, std::min(finding.find("; "), finding.find(". ")));
  if (first.size() <= kMaxFindingLength) return first;
  const std::size_t blank = first.rfind(' ', kMaxFindingLength);
  first.resize(blank == std::string::npos ? kMaxFindingLength : blank);
  return first + " ...";
}

bool is_over(Source source, std::string_view finding, const agent::Perception& perception, Stamp now) {
  if (finding.starts_with("stamps are ")) {
    const auto behind = perception.clock_offsets().behind(source);
    return behind && std::abs(*behind) < sensor::ClockOffsets::kReportedOffset;
  }
  if (finding.starts_with("no fix since ") || finding.starts_with("no fix in the first ") ||
      finding.starts_with("no sample since ")) {
    const auto last = perception.last_sound(source);
    return last && now - *last < kSendsAgain;
  }
  return false;
}

}  // namespace

std::vector<SensorFinding> sensor_findings(const agent::Perception& perception, Stamp now) {
  std::vector<SensorFinding> all;
  for (const std::string& finding : perception.health().alarms()) {
    SensorFinding& one = all.emplace_back();
    one.text = in_short(finding);
    for (const auto& [beginning, source] : kBeginnings) {
      if (!finding.starts_with(beginning)) continue;
      one.source = source;
      one.is_over = is_over(source, std::string_view(finding).substr(beginning.size()), perception, now);
    }
  }
  return all;
}

}  // namespace fleetmap::apps
