#include "map_progress.hpp"

#include <algorithm>
#include <limits>

namespace fleetmap::apps {

monitor::FleetMaps MapProgress::add(const std::vector<monitor::RobotNow>& robots, const AgentId& self,
                                    double lost_after_s, Stamp now) {
  monitor::FleetMaps maps;
  std::vector<const monitor::RobotNow*> counted;
  std::size_t complete = 0;
  for (const monitor::RobotNow& robot : robots) {
    if (robot.id != self && (robot.heard.empty() || robot.heard.front().seconds_ago > lost_after_s)) {
      maps.not_counted.push_back(robot.id);
      submaps_.erase(robot.id);
      continue;
    }
    counted.push_back(&robot);
    complete = std::max({complete, robot.nodes, robot.submaps});
  }
  double longest = 0.0;
  for (const monitor::RobotNow* robot : counted) {
    const double rate = rate_of(*robot, now);
    if (robot->submaps == complete) continue;
    const std::size_t missing = complete - robot->submaps;
    const double seconds =
        rate > 0.0 ? static_cast<double>(missing) / rate : std::numeric_limits<double>::infinity();
    if (maps.last && seconds <= longest) continue;
    longest = seconds;
    maps.last = robot->id;
    maps.missing_submaps = missing;
  }
  if (longest < std::numeric_limits<double>::infinity()) maps.seconds_to_equal = longest;
  return maps;
}

double MapProgress::rate_of(const monitor::RobotNow& robot, Stamp now) {
  Counts& counts = submaps_[robot.id];
  // A robot whose disk was lost begins anew.
  if (!counts.empty() && robot.submaps < counts.back().second) counts.clear();
  counts.emplace_back(now, robot.submaps);
  while (now - counts.front().first > kWindow) counts.pop_front();
  const Duration window = now - counts.front().first;
  if (window < kMinWindow) return 0.0;
  return static_cast<double>(robot.submaps - counts.front().second) / to_seconds(window);
}

}  // namespace fleetmap::apps
