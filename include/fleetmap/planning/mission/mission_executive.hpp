#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/messages/messages.hpp"
#include "fleetmap/planning/mission/fleet_plan.hpp"
#include "fleetmap/planning/mission/mission_config.hpp"
#include "fleetmap/planning/site/mission.hpp"

namespace fleetmap::planning {

using messages::MissionReport;
using messages::MissionState;
using messages::RowSet;

class ExecutiveState;

/// State of the robot itself, passed some times a second.
struct MissionInput {
  Stamp now;
  Pose2 pose;
  double battery = 1.0;  ///< share left, [0, 1]
  /// The path that the follower is at (MissionAction::path_number), and what it says of it.
  std::uint64_t path_number = 0;
  bool finished = false;
  bool stuck = false;
  double progress = 0.0;  ///< m along the path
  /// An operator's order to drive home is in force.
  bool called_home = false;
  /// Everything that was to be exchanged at the rendezvous is.
  bool maps_exchanged = false;
  /// Robots within reach who hold all maps that this one holds, and the other way round.
  std::vector<AgentId> exchanged_with = {};
  /// Rows along which the fleet's nodes lie (RowCoverage).
  RowSet surveyed = {};
};

/// The action that the executive orders at one time.
struct MissionAction {
  enum class Kind : std::uint8_t {
    kFollow,  ///< drive `path`
    kHold,    ///< stand where you are
    kDone,    ///< the mission is over
  };
  Kind kind = Kind::kHold;
  Polyline path;                  ///< ENU, m
  std::uint64_t path_number = 0;  ///< a new number, a new path
};

/// One robot's part in a mission without a leader. All start from the same division; from then on each robot
/// acts on its own state and the reports that it received:
/// - a row counts as driven if the robot that the plan gives it to reports so and is not lost, or if any
/// robot
///   reports so and nodes of the fleet lie along it; every report repeats this;
/// - a row that two claim stays with the one that is under way on it, else with the lower name;
/// - a row that is blocked is tried from both ends, by two robots where two are left, and then abandoned;
/// - rows of a robot that is lost, stuck, low on battery or called home are unclaimed; each of the others
///   computes the same division of them, and a row that is still unclaimed after a while is taken by any;
/// - a robot with many rows left gives some away when another one has none (the late one, the returned one);
/// - a row that an operator gives to a robot is claimed by it, and its former owner keeps it until then; one
///   that he takes from a robot goes to another one, unless no other can drive it;
/// - two robots that the plan lets stop to exchange maps drive there in the plan's order of rows and wait for
///   each other for a limited time, and not for one that is lost or got other rows.
/// So no row stays undone while a robot remains that can reach it; at worst one is driven twice.
/// Deterministic, no clock of its own; not thread-safe.
class MissionExecutive {
 public:
  /// Fails if `self` is not in the fleet.
  static Result<MissionExecutive> create(std::shared_ptr<const FleetPlan> plan, const AgentId& self);
  /// The same, planning for itself.
  static Result<MissionExecutive> create(Mission mission, const AgentId& self,
                                         std::span<const RobotAbility> fleet, const MissionConfig& config);
  ~MissionExecutive();
  MissionExecutive(MissionExecutive&&) noexcept;
  MissionExecutive& operator=(MissionExecutive&&) noexcept;

  /// Processes another robot's report; those that are unknown, own, old or invalid are ignored.
  void on_report(const MissionReport& report, Stamp now);
  /// The operators' orders for rows that are in force, of those given so far. Orders for rows or robots that
  /// the mission does not have are ignored.
  void set_row_orders(const std::vector<messages::RowOrder>& orders);
  MissionAction update(const MissionInput& input);
  /// As of the last update.
  MissionReport report() const;
  /// The last report of each other robot, as far as any was received.
  std::vector<MissionReport> heard_reports() const;

  struct Abandoned {
    RowId row = 0;
    std::string why;  ///< this robot gave it up; empty: only others did, or no robot is left to drive it
  };
  struct Unconfirmed {
    RowId row = 0;
    AgentId by;
  };
  struct Status {
    MissionState state = MissionState::kDriving;
    std::size_t rows = 0;
    std::size_t done = 0;              ///< by anyone, as far as is known
    std::size_t mine = 0;              ///< still claimed by this robot
    std::vector<Abandoned> abandoned;  ///< rows that are not driven any more
    /// Rows that a robot says it drove, but along which no nodes lie.
    std::vector<Unconfirmed> unconfirmed;
    std::vector<AgentId> lost;
    std::vector<AgentId> expected;  ///< others who are to come to the meeting
    std::uint64_t replans = 0;      ///< rows taken over or given away
    std::size_t stops_kept = 0;     ///< maps were exchanged
    std::size_t stops_dropped = 0;  ///< the partner did not come, or one of the two got other rows
  };
  Status status() const;
  const FleetPlan& plan() const;

 private:
  explicit MissionExecutive(std::unique_ptr<ExecutiveState> state);
  std::unique_ptr<ExecutiveState> state_;
};

}  // namespace fleetmap::planning
