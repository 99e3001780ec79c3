#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "fleetmap/planning/mission/mission_executive.hpp"
#include "mission/appointments.hpp"
#include "mission/blocked_places.hpp"
#include "mission/mission_board.hpp"
#include "mission/row_attempts.hpp"
#include "mission/row_claims.hpp"

namespace fleetmap::planning {

/// Destination of a robot.
enum class Goal : std::uint8_t { kNone, kRow, kStop, kMeeting, kHome };

/// State of one robot, its goal and the path there. MissionExecutive::update() calls these steps in order.
class ExecutiveState {
 public:
  ExecutiveState(std::shared_ptr<const FleetPlan> shared, std::size_t index);

  void begin(const MissionInput& input);
  /// Ends or gives up the path under way, as the follower reports.
  void follow_up(const MissionInput& input);
  /// Begins or ends the way home by an operator's order.
  void check_call(const MissionInput& input);
  /// Low is also a battery that just suffices for the way home.
  void check_battery(const MissionInput& input);
  void update_claims(Stamp now);
  void share_work(const MissionInput& input);
  void update_appointments();
  /// Selects the next goal if nothing is under way or something better turned up.
  void select_goal(const MissionInput& input);
  void update_report(const MissionInput& input);

  const ExecutiveConfig& rules() const { return plan->config.executive; }
  const RobotAbility& robot() const { return plan->fleet[self]; }

  std::shared_ptr<const FleetPlan> plan;
  std::size_t self;
  MissionBoard board;
  Appointments appointments;
  RowClaims claims;
  RowAttempts attempts;
  MissionState state = MissionState::kDriving;
  bool begun = false;
  Goal goal = Goal::kNone;
  Stamp listen_until{};
  Polyline path;
  std::uint64_t path_number = 0;
  MissionReport report;

 private:
  void row_blocked(const MissionInput& input);
  void recover();
  void stop();
  void release_all();
  bool drives_home() const {
    return state == MissionState::kLowBattery || state == MissionState::kCalledHome;
  }
  void begin_way_home(MissionState why);
  void end_way_home();
  bool on_schedule(Stamp now) const;
  void end_stop(bool kept);
  bool keep_appointment(const MissionInput& input);
  double patience(const Appointments::Stop& stop, Stamp now) const;
  RowVisit next_row(const MissionInput& input) const;
  void start_row(const MissionInput& input);
  bool go(Goal where, const Eigen::Vector2d& place, const MissionInput& input);
  bool alone_too_long(bool nothing_to_come, Stamp now);
  void go_home(const MissionInput& input, bool finished, bool alone);
  void wait_stuck(const MissionInput& input, bool alone);
  void meet(const MissionInput& input, bool finished, bool alone);
  bool may_set_out(Stamp now) const { return goal == Goal::kNone && now >= retry_at_; }

  Eigen::Vector2d home_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d stuck_at_ = Eigen::Vector2d::Zero();
  Stamp begun_at_{};
  double row_begins_ = 0.0;           // m along the path
  std::optional<Stamp> waits_until_;  // at a stop: for the partner to come
  std::optional<Stamp> stays_until_;  // at a stop: for the exchange to end
  Stamp retry_at_{};
  int stuck_in_a_row_ = 0;
  bool arrived_ = false;  // where it last wanted to go
  bool called_home_ = false;
  BlockedPlaces blocked_;
  std::optional<Stamp> all_done_since_;
};

}  // namespace fleetmap::planning
