#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/messages/messages.hpp"
#include "fleetmap/monitor/live_status.hpp"
#include "fleetmap/orders/hold_orders.hpp"
#include "fleetmap/planning/site/mission.hpp"
#include "robot/link_log.hpp"

namespace fleetmap::apps {

/// The fleet as one robot has heard of it, and its own state.
struct FleetState {
  AgentId self;
  std::vector<AgentId> fleet;
  Stamp now;
  std::map<AgentId, messages::AgentStatus> statuses;   ///< the own one too
  std::map<AgentId, messages::Hold::Driving> driving;  ///< likewise
  std::map<AgentId, messages::MissionReport> reports;  ///< likewise
  std::vector<messages::HoldOrder> orders;             ///< in force or replaced by those for one robot
  std::vector<messages::RowOrder> row_orders;          ///< in force
  std::map<LinkLog::Source, LinkLog::Heard> heard;
  std::map<AgentId, std::uint64_t> misbehaved;           ///< messages that contradict the rules
  std::vector<planning::Row> rows;                       ///< of the mission, in its order
  std::map<AgentId, Eigen::Vector2d> starts;             ///< in the mission, ENU, m
  std::string stop_reason;                               ///< why this robot stands still; empty: it does not
  std::map<AgentId, std::vector<std::string>> problems;  ///< of the robots whose insides are known
  std::map<AgentId, std::vector<std::string>> totals;    ///< likewise, since they started
};

/// Activity of a robot by its last report, in words. `heading`: its last one, rad from east; `start`: where
/// it began, ENU, m; each if it is known.
std::string activity_of(const messages::MissionReport& report, const std::vector<planning::Row>& rows,
                        std::optional<double> heading, std::optional<Eigen::Vector2d> start);

/// Makes it a problem that a robot was heard, and is silent for longer than `lost_after` (s).
void add_silence(double lost_after, monitor::RobotNow& robot);

/// Every robot of the fleet, by name.
std::vector<monitor::RobotNow> robot_states(const FleetState& fleet);

}  // namespace fleetmap::apps
