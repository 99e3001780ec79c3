#include "fleetmap/planning/mission/mission_executive.hpp"

#include <cmath>
#include <utility>

#include "mission/executive_state.hpp"

namespace fleetmap::planning {

MissionExecutive::MissionExecutive(std::unique_ptr<ExecutiveState> state) : state_(std::move(state)) {}
MissionExecutive::~MissionExecutive() = default;
MissionExecutive::MissionExecutive(MissionExecutive&&) noexcept = default;
MissionExecutive& MissionExecutive::operator=(MissionExecutive&&) noexcept = default;

Result<MissionExecutive> MissionExecutive::create(std::shared_ptr<const FleetPlan> plan,
                                                  const AgentId& self) {
  const auto index = plan->find(self);
  if (!index) return failure("mission: robot " + self.str() + " is not in the fleet");
  return MissionExecutive(std::make_unique<ExecutiveState>(std::move(plan), *index));
}

Result<MissionExecutive> MissionExecutive::create(Mission mission, const AgentId& self,
                                                  std::span<const RobotAbility> fleet,
                                                  const MissionConfig& config) {
  auto plan = plan_fleet(std::move(mission), fleet, config);
  if (!plan) return tl::unexpected(plan.error());
  return create(std::move(*plan), self);
}

void MissionExecutive::on_report(const MissionReport& report, Stamp now) { state_->board.hear(report, now); }

void MissionExecutive::set_row_orders(const std::vector<messages::RowOrder>& orders) {
  state_->board.set_row_orders(orders);
}

MissionAction MissionExecutive::update(const MissionInput& input) {
  ExecutiveState& s = *state_;
  if (!input.pose.position.allFinite() || !std::isfinite(input.pose.yaw)) {
    return {MissionAction::Kind::kHold, {}, s.path_number};
  }
  if (!s.begun) s.begin(input);
  s.board.set_surveyed(input.surveyed, input.now);
  s.follow_up(input);
  s.check_call(input);
  s.check_battery(input);
  s.update_claims(input.now);
  s.update_report(input);
  if (input.now < s.listen_until) return {MissionAction::Kind::kHold, {}, s.path_number};
  if (s.board.available(s.self, input.now)) s.share_work(input);
  s.update_appointments();
  s.select_goal(input);
  s.update_report(input);
  if (s.state == MissionState::kDone) return {MissionAction::Kind::kDone, {}, s.path_number};
  if (s.goal == Goal::kNone) return {MissionAction::Kind::kHold, {}, s.path_number};
  return {MissionAction::Kind::kFollow, s.path, s.path_number};
}

MissionReport MissionExecutive::report() const { return state_->report; }

std::vector<MissionReport> MissionExecutive::heard_reports() const {
  std::vector<MissionReport> reports;
  for (std::size_t robot = 0; robot < state_->board.robots(); ++robot) {
    const MissionReport* last = robot == state_->self ? nullptr : state_->board.report_of(robot);
    if (last != nullptr) reports.push_back(*last);
  }
  return reports;
}

MissionExecutive::Status MissionExecutive::status() const {
  const ExecutiveState& s = *state_;
  const Stamp now = s.report.stamp;
  Status status;
  status.state = s.state;
  status.rows = s.board.rows();
  status.done = s.board.done().count();
  status.mine = s.report.claimed.count();
  status.replans = s.claims.changes() + s.attempts.times_abandoned();
  status.stops_kept = s.appointments.count_kept();
  status.stops_dropped = s.appointments.count_dropped();
  for (std::size_t row = 0; row < s.board.rows(); ++row) {
    if (s.board.done().has(row)) continue;
    if (!s.board.abandoned(row, now) && s.state != MissionState::kDone) continue;
    status.abandoned.push_back({s.plan->mission.rows[row].id, s.attempts.reason(row)});
  }
  for (const auto& [row, robot] : s.board.unconfirmed())
    status.unconfirmed.push_back({s.plan->mission.rows[row].id, s.plan->fleet[robot].id});
  for (std::size_t robot = 0; robot < s.board.robots(); ++robot) {
    if (robot == s.self) continue;
    if (s.board.lost(robot, now)) status.lost.push_back(s.plan->fleet[robot].id);
    if (s.board.available(robot, now)) status.expected.push_back(s.plan->fleet[robot].id);
  }
  return status;
}

const FleetPlan& MissionExecutive::plan() const { return *state_->plan; }

}  // namespace fleetmap::planning
