#include "run_profile.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

namespace fleetmap::apps {
namespace {

using Entries = std::array<std::pair<const char*, double>, 9>;

Entries entries_of(const RunProfile& profile) {
  return {{{"rays", profile.feed.rays},
           {"odometry", profile.work.odometry},
           {"registration", profile.work.registration},
           {"spherization", profile.work.spherization},
           {"placement", profile.work.placement},
           {"driving", profile.feed.driving},
           {"results", profile.results},
           {"set_up", profile.set_up},
           {"rest", profile.rest()}}};
}

double ratio(double a, double b) { return b > 0.0 ? a / b : 0.0; }

}  // namespace

double RunProfile::rest() const {
  const double named = feed.rays + feed.driving + work.odometry + work.registration + work.spherization +
                       work.placement + results + set_up;
  return std::max(0.0, cpu - named);
}

RunProfile profile_of(const FleetOutcome& outcome, double cpu_before, double cpu, double wall_seconds) {
  return {outcome.feed_seconds,
          outcome.work_seconds,
          outcome.results_seconds,
          cpu_before,
          cpu,
          wall_seconds,
          to_seconds(outcome.virtual_time)};
}

nlohmann::json to_json(const RunProfile& profile) {
  nlohmann::json out{{"cpu_s", profile.cpu},
                     {"wall_s", profile.wall},
                     {"times_real_time", ratio(profile.virtual_time, profile.wall)}};
  for (const auto& [name, seconds] : entries_of(profile)) {
    out[std::string(name) + "_s"] = seconds;
    out["shares"][name] = ratio(seconds, profile.cpu);
  }
  return out;
}

std::string summary_of(const RunProfile& profile) {
  char text[160];
  std::snprintf(text, sizeof text,
                "%.0f s of virtual time in %.0f s, %.1f times real time, %.0f s of CPU:\n ",
                profile.virtual_time, profile.wall, ratio(profile.virtual_time, profile.wall), profile.cpu);
  std::string all = text;
  for (const auto& [name, seconds] : entries_of(profile)) {
    std::snprintf(text, sizeof text, "%s %s %.0f %%", all.back() == ' ' ? "" : ",", name,
                  100.0 * ratio(seconds, profile.cpu));
    all += text;
  }
  return all;
}

}  // namespace fleetmap::apps
