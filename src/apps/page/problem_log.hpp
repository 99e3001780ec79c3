#pragma once

#include <map>
#include <optional>
#include <string>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/monitor/live_status.hpp"

namespace fleetmap::apps {

/// Follows the problems of robots from second to second, so that those whose cause has ended are shown as
/// past.
class ProblemLog {
 public:
  /// A total that grew no more for so long is past.
  static constexpr Duration kGrows = std::chrono::seconds(60);

  /// Leaves in `robot.problems` what is there now, and writes into `robot.past` what was there before.
  /// Problems that differ in their numbers alone are one.
  void update(monitor::RobotNow& robot, Stamp now);

 private:
  struct Entry {
    std::string text;
    bool is_total = false;
    bool is_reported = false;   ///< by the newest status
    std::optional<Stamp> last;  ///< it was there, or grew; empty: a total from before the first look
    bool is_present = false;
  };
  using Entries = std::map<std::string, Entry>;
  static bool note(const std::string& problem, bool is_total, bool first_look, Stamp now, Entries& entries);

  std::map<AgentId, Entries> robots_;
};

}  // namespace fleetmap::apps
