#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "fleetmap/planning/mission/mission_executive.hpp"
#include "fleetmap/planning/mission/row_coverage.hpp"

namespace fleetmap::fault_injection {

/// The rows that the robots of a fleet drive, on a field of their own: each has a mission executive and
/// follows its path exactly. Nodes lie along what was driven, and every robot has them.
class SimulatedMission {
 public:
  /// Two rows for each robot.
  explicit SimulatedMission(const std::vector<AgentId>& fleet);

  /// The robot's program starts, where the robot stands.
  void start(const AgentId& robot);
  /// It ends, and with it all that it heard.
  void stop(const AgentId& robot) { robots_.at(robot).executive.reset(); }
  void on_report(const AgentId& robot, const messages::MissionReport& report, Stamp now);
  /// A running robot drives for `seconds` and updates its executive.
  void drive(const AgentId& robot, double seconds, Stamp now);
  messages::MissionReport report(const AgentId& robot) const { return robots_.at(robot).executive->report(); }
  /// The report of a robot that claims to know of all rows that they were driven.
  messages::MissionReport false_report(const AgentId& robot, Stamp now) const;

  /// A row that this running robot counts as driven, though nobody drove it. Not one that the plan gives to
  /// `compromised`, whose word counts for its own rows.
  std::optional<std::size_t> skipped_row(const AgentId& robot,
                                         const std::optional<AgentId>& compromised) const;

 private:
  struct Robot {
    std::size_t index = 0;  ///< in the plan
    std::unique_ptr<planning::MissionExecutive> executive;
    planning::Pose2 pose;
    planning::MissionAction action;
    double along = 0.0;  ///< m of action.path
  };
  void move(Robot& robot, double metres);
  void mark(const Eigen::Vector2d& at);
  bool is_driven(std::size_t row) const;

  std::shared_ptr<const planning::FleetPlan> plan_;
  planning::RowCoverage coverage_;
  std::map<AgentId, Robot> robots_;
  std::vector<std::set<int>> metres_;  ///< driven, of each row
};

}  // namespace fleetmap::fault_injection
