#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <map>
#include <utility>
#include <vector>

#include "fleetmap/core/time.hpp"
#include "fleetmap/monitor/live_status.hpp"

namespace fleetmap::apps {

/// The rate at which the robots' maps become equal, by the nodes and submaps that their statuses count.
class MapProgress {
 public:
  static constexpr Duration kWindow = std::chrono::minutes(1);
  /// Rates are not known before a window is as long.
  static constexpr Duration kMinWindow = std::chrono::seconds(10);

  /// To be called once a second with what robot_states() made at `now`. Robots other than `self` that were
  /// not heard for `lost_after_s` are not counted. A complete map has the most nodes that any robot holds.
  monitor::FleetMaps add(const std::vector<monitor::RobotNow>& robots, const AgentId& self,
                         double lost_after_s, Stamp now);

 private:
  using Counts = std::deque<std::pair<Stamp, std::size_t>>;
  /// Submaps a second that the robot received in the window; 0 while the window is too short.
  double rate_of(const monitor::RobotNow& robot, Stamp now);

  std::map<AgentId, Counts> submaps_;
};

}  // namespace fleetmap::apps
