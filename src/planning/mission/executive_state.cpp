#include "mission/executive_state.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mission/row_order.hpp"

namespace fleetmap::planning {
namespace {

constexpr double kAtStart = 12.0;    // m; a robot that begins farther from its start was restarted
constexpr double kMoved = 3.0;       // m between two places at which it is stuck that are not the same
constexpr double kRecovered = 0.2;   // share of the battery above the low mark at which it is used again
constexpr double kRouteRetry = 5.0;  // s, when no way was found from where it seems to be
constexpr double kMaxPlannedWait = 86400.0;  // s, of an exchange at the meeting

}  // namespace

ExecutiveState::ExecutiveState(std::shared_ptr<const FleetPlan> shared, std::size_t index)
    : plan(std::move(shared)),
      self(index),
      board(plan, index),
      appointments(*plan, index),
      claims(plan, index),
      attempts(plan->mission.rows.size()) {}

void ExecutiveState::begin(const MissionInput& input) {
  begun = true;
  begun_at_ = input.now;
  board.begin(input.now);
  const bool restarted = (input.pose.position - robot().start.position).norm() > kAtStart;
  listen_until = input.now + from_seconds(restarted ? rules().listen : 0.0);
  home_ = restarted ? robot().start.position : input.pose.position;
  claims.begin();
}

void ExecutiveState::stop() {
  goal = Goal::kNone;
  path.clear();
}

void ExecutiveState::release_all() {
  claims.release_all();
  appointments.drop_all();
  stop();
}

void ExecutiveState::row_blocked(const MissionInput& input) {
  const std::size_t row = *claims.current();
  claims.end_current();
  const RowAttempts::Outcome outcome =
      attempts.blocked(row, input.progress - row_begins_, plan->costs.along(row).length, input.pose.position,
                       rules().row_attempts);
  if (outcome == RowAttempts::Outcome::kDriven) return board.set_done(row);
  appointments.drop_all();
  if (outcome == RowAttempts::Outcome::kRetry) claims.defer(row);
}

/// It can move again: what it gave up because it was stuck may be tried anew.
void ExecutiveState::recover() {
  state = MissionState::kDriving;
  stuck_in_a_row_ = 0;
  attempts.reset();
}

void ExecutiveState::follow_up(const MissionInput& input) {
  if (goal == Goal::kNone || input.path_number != path_number) return;
  if (input.finished) {
    stuck_in_a_row_ = 0;
    if (goal == Goal::kRow && claims.current()) {
      board.set_done(*claims.current());
      claims.end_current();
    } else {
      arrived_ = true;
    }
    return stop();
  }
  const double moved = (input.pose.position - stuck_at_).norm();
  if (state == MissionState::kStuck && moved > kMoved) recover();
  if (!input.stuck) return;
  stuck_in_a_row_ = moved < kMoved ? stuck_in_a_row_ + 1 : 1;
  stuck_at_ = input.pose.position;
  blocked_.add(path, input.progress, input.pose.position, input.now);
  if (goal == Goal::kRow && claims.current()) row_blocked(input);
  // Near enough to talk to the others is near enough.
  const bool near = goal == Goal::kMeeting && plan->meeting &&
                    (plan->meeting->place - stuck_at_).norm() < 0.5 * plan->config.meeting.c_max;
  arrived_ = near && stuck_in_a_row_ > 1;
  if (goal == Goal::kStop) end_stop(false);
  const bool elsewhere = goal == Goal::kRow || goal == Goal::kStop;  // what comes next leads another way
  retry_at_ = elsewhere ? input.now : input.now + from_seconds(rules().stuck_retry);
  stop();
  if (stuck_in_a_row_ >= rules().stuck_limit && !drives_home()) {
    state = MissionState::kStuck;
    release_all();
    retry_at_ = input.now + from_seconds(rules().stuck_retry);
  }
}

void ExecutiveState::begin_way_home(MissionState why) {
  state = why;
  arrived_ = false;
  release_all();
}

void ExecutiveState::end_way_home() {
  state = MissionState::kDriving;
  arrived_ = false;
  stop();
}

void ExecutiveState::check_call(const MissionInput& input) {
  if (input.called_home == std::exchange(called_home_, input.called_home)) return;
  if (state == MissionState::kLowBattery) return;  // it drives home anyway
  if (called_home_) return begin_way_home(MissionState::kCalledHome);
  if (state != MissionState::kDone || !board.all_finished(input.now)) end_way_home();
}

void ExecutiveState::check_battery(const MissionInput& input) {
  if (!std::isfinite(input.battery) || state == MissionState::kDone) return;
  const double way = 1.4 * (input.pose.position - home_).norm();
  const double share_home =
      energy_of({static_cast<float>(way), 0.0f}, robot()) / robot().battery_wh + 0.5 * rules().low_battery;
  const double mark = std::max(rules().low_battery, std::min(share_home, 0.5));
  if (state != MissionState::kLowBattery && input.battery <= mark) {
    begin_way_home(MissionState::kLowBattery);
  } else if (state == MissionState::kLowBattery && input.battery > mark + kRecovered) {
    called_home_ ? begin_way_home(MissionState::kCalledHome) : end_way_home();
  }
}

void ExecutiveState::update_claims(Stamp now) {
  if (state == MissionState::kDriving || state == MissionState::kMeeting)
    claims.take_ordered(board, attempts.abandoned(), now);
  if (claims.drop_lost(board, attempts.abandoned(), now)) stop();
}

/// On schedule of a plan with stops, which lets some robots be done before others on purpose.
bool ExecutiveState::on_schedule(Stamp now) const {
  if (!appointments.keeps_order()) return false;
  if (appointments.next()) return true;  // the partner at the stop waits for it
  const double end = to_seconds(now - begun_at_) + board.remaining(self);
  return end < plan->division.routes[self].time + rules().offer_gain;
}

void ExecutiveState::share_work(const MissionInput& input) {
  claims.take_orphans(board, attempts.abandoned(), input.now);
  if (on_schedule(input.now)) return;
  const double left = std::max(0.0, length_of(path) - input.progress);
  const double busy = claims.current() ? left / robot().speed : 0.0;
  const bool on_row = claims.current() && !path.empty();
  const Pose2 then = on_row ? Pose2{path.back(), input.pose.yaw} : input.pose;
  claims.give_away(board, busy, then, input.now);
}

void ExecutiveState::update_appointments() {
  appointments.update(claims.all(), claims.current());
  if (!appointments.next() && goal == Goal::kStop) stop();
}

void ExecutiveState::end_stop(bool kept) {
  kept ? appointments.kept() : appointments.dropped();
  waits_until_.reset();
  stays_until_.reset();
  arrived_ = false;
  if (goal == Goal::kStop) stop();
}

/// s that it waits for the partner. If it is late itself, the partner may be as late for the same reasons.
double ExecutiveState::patience(const Appointments::Stop& stop, Stamp now) const {
  const double late = std::max(1.0, to_seconds(now - begun_at_) / std::max(1.0, stop.arrival));
  return std::max(0.0, std::min(late, 2.0) * (stop.partner_arrival - stop.arrival)) + rules().stop_patience;
}

/// Goes to the next stop, if it is due, and waits there. False once there is none.
bool ExecutiveState::keep_appointment(const MissionInput& input) {
  if (!appointments.due(claims.queue())) return false;
  const Appointments::Stop& stop = *appointments.next();
  const auto partner = appointments.partner(stop, board, input.now);
  const bool even =
      std::ranges::find(input.exchanged_with, plan->fleet[stop.partner].id) != input.exchanged_with.end();
  if (even && partner != Appointments::Partner::kComing) return end_stop(true), false;
  if (partner == Appointments::Partner::kGone) return end_stop(false), false;
  if (!arrived_) {
    if (goal != Goal::kStop && !go(Goal::kStop, stop.place, input)) return end_stop(false), false;
    return true;
  }
  if (!waits_until_) waits_until_ = input.now + from_seconds(patience(stop, input.now));
  const double apart = (board.position(stop.partner) - input.pose.position).norm();
  if (!stays_until_ && partner == Appointments::Partner::kDue && apart < plan->config.meeting.c_max) {
    stays_until_ = input.now + from_seconds(2.0 * stop.transfer + rules().stop_patience);
  }
  if (input.now > stays_until_.value_or(*waits_until_)) return end_stop(false), false;
  return true;
}

/// In the order of the plan if others count on it; else on the shortest way through all that are left.
RowVisit ExecutiveState::next_row(const MissionInput& input) const {
  if (appointments.keeps_order()) {
    const Appointments::Visit visit = appointments.next_visit(claims.queue());
    return {plan->mission.rows[visit.row].id, visit.reversed};
  }
  std::vector<std::size_t> untried;
  for (const std::size_t row : claims.queue()) {
    if (!attempts.tried(row)) untried.push_back(row);
  }
  return first_visit(*plan, self, input.pose, untried.empty() ? claims.queue() : untried);
}

void ExecutiveState::start_row(const MissionInput& input) {
  claims.sort();
  const RowVisit next = next_row(input);
  const auto found = std::ranges::find(plan->mission.rows, next.row, &Row::id);
  const auto row = static_cast<std::size_t>(found - plan->mission.rows.begin());
  const bool reversed = attempts.next_reversed(row, next.reversed);
  const auto along = plan->planner.along(*found, reversed);
  const auto way =
      along ? blocked_.route(plan->planner, input.pose.position, along->front(), input.now) : along;
  if (!way) {
    retry_at_ = input.now + from_seconds(kRouteRetry);
    if (attempts.unreachable(row, way.error().message)) claims.drop(row);
    return;
  }
  claims.start(row);
  attempts.begin(row, reversed);
  path = *way;
  row_begins_ = length_of(path);
  path.insert(path.end(), along->begin(), along->end());
  goal = Goal::kRow;
  ++path_number;
  arrived_ = false;
}

bool ExecutiveState::go(Goal where, const Eigen::Vector2d& place, const MissionInput& input) {
  const auto way = blocked_.route(plan->planner, input.pose.position, place, input.now);
  if (!way) {
    retry_at_ = input.now + from_seconds(kRouteRetry);
    return false;
  }
  path = *way;
  goal = where;
  ++path_number;
  return true;
}

/// No row is left to drive, and the others did not come for longer than the exchange at the meeting takes.
bool ExecutiveState::alone_too_long(bool nothing_to_come, Stamp now) {
  if (!nothing_to_come) all_done_since_.reset();
  if (nothing_to_come && !all_done_since_) all_done_since_ = now;
  const double planned =
      plan->exchange ? std::min(plan->exchange->transfer_at_meeting, kMaxPlannedWait) : 0.0;
  return all_done_since_ && now - *all_done_since_ > from_seconds(rules().meeting_timeout + planned);
}

void ExecutiveState::go_home(const MissionInput& input, bool finished, bool alone) {
  const bool may_go = may_set_out(input.now);
  if (finished && arrived_ && input.maps_exchanged) state = MissionState::kDone;
  if (goal == Goal::kNone && alone) state = MissionState::kDone;
  if (state != MissionState::kDone && may_go && !arrived_) go(Goal::kHome, home_, input);
}

void ExecutiveState::wait_stuck(const MissionInput& input, bool alone) {
  if (may_set_out(input.now))
    go(Goal::kMeeting, plan->meeting ? plan->meeting->positions[self] : home_, input);
  if (alone) state = MissionState::kDone;
}

void ExecutiveState::meet(const MissionInput& input, bool finished, bool alone) {
  if (plan->meeting && !arrived_) {
    state = MissionState::kDriving;
    if (goal == Goal::kMeeting) return;
    if (alone) {
      state = MissionState::kDone;  // it found no way there
    } else if (input.now >= retry_at_) {
      go(Goal::kMeeting, plan->meeting->positions[self], input);
    }
    return;
  }
  state = plan->meeting ? MissionState::kMeeting : MissionState::kDriving;
  if (finished && (!plan->meeting || input.maps_exchanged || alone)) state = MissionState::kDone;
}

void ExecutiveState::select_goal(const MissionInput& input) {
  if (state == MissionState::kDone) return;
  const bool finished = board.all_finished(input.now);
  const bool alone = alone_too_long(finished || board.nobody_left(input.now), input.now);
  if (drives_home()) return go_home(input, finished, alone);
  if (state == MissionState::kStuck) return wait_stuck(input, alone);
  if (claims.current() || keep_appointment(input)) {
    state = MissionState::kDriving;
  } else if (!claims.queue().empty()) {
    state = MissionState::kDriving;
    if (input.now >= retry_at_) start_row(input);
  } else {
    meet(input, finished, alone);
  }
}

void ExecutiveState::update_report(const MissionInput& input) {
  const auto& current = claims.current();
  report.from = robot().id;
  report.stamp = input.now;
  report.state = state;
  if (input.pose.position.allFinite()) report.position = input.pose.position;
  report.battery = input.battery;
  report.current = current ? static_cast<std::uint32_t>(*current) : MissionReport::kNoRow;
  report.done = board.done();
  report.claimed = claims.as_set();
  report.failed = attempts.abandoned();
  board.set_own(report);
}

}  // namespace fleetmap::planning
