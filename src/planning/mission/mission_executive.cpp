#include "fleetmap/planning/mission/mission_executive.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>

#include "mission/appointments.hpp"
#include "mission/mission_board.hpp"

namespace fleetmap::planning {
namespace {

constexpr double kAtStart = 12.0;        // m; a robot that begins farther from its start was restarted
constexpr double kMoved = 3.0;           // m between two places at which it is stuck that are not the same
constexpr double kCovered = 0.9;         // share of a row that counts as driven if both ends were tried
constexpr double kSeenAcross = 8.0;      // m between the two places at which it was stopped, seen from both
constexpr double kTakeoverPeriod = 5.0;  // s between two looks at who takes the orphans
constexpr double kRecovered = 0.2;       // share of the battery above the low mark at which it is used again
constexpr double kRouteRetry = 5.0;      // s, when no way was found from where it seems to be

constexpr double kAhead = 2.0;        // m from where it is stuck to what is in the way
constexpr double kLongest = 86400.0;  // s, of an exchange that is waited for
constexpr double kForgotten = 300.0;  // s, after which a blocked place is tried again
constexpr std::size_t kMostBlockages = 12;
constexpr int kMostFailedRoutes = 4;  // to one row, every kRouteRetry, until the robot gives it up

std::string text(const Eigen::Vector2d& p) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "(%.1f, %.1f)", p.x(), p.y());
  return buffer;
}

enum class Goal : std::uint8_t { kNone, kRow, kStop, kMeeting, kHome };

}  // namespace

struct MissionExecutive::State {
  State(std::shared_ptr<const FleetPlan> shared, std::size_t index)
      : plan(std::move(shared)),
        self(index),
        board(plan, index),
        appointments(*plan, index),
        failed(plan->mission.rows.size()),
        attempts(plan->mission.rows.size(), 0),
        last_reversed(plan->mission.rows.size(), false),
        covered(plan->mission.rows.size(), {0.0, 0.0}),
        failed_routes(plan->mission.rows.size(), 0),
        why(plan->mission.rows.size()),
        orphan_since(plan->mission.rows.size()) {}

  const ExecutiveConfig& rules() const { return plan->config.executive; }
  const RobotAbility& robot() const { return plan->fleet[self]; }

  void begin(const MissionInput& input);
  void look_at_follower(const MissionInput& input);
  void row_stuck(const MissionInput& input);
  void give_up(std::size_t row, std::string reason);
  void remember_blockage(const MissionInput& input);
  Result<Polyline> way_to(const Eigen::Vector2d& place, const MissionInput& input);
  void look_at_battery(const MissionInput& input);
  void settle_claims(Stamp now);
  void take_orphans(Stamp now);
  bool on_schedule(Stamp now) const;
  void give_away(const MissionInput& input);
  void release_all();
  void choose(const MissionInput& input);
  void look_at_appointments();
  void end_stop(bool kept);
  bool keep_appointment(const MissionInput& input);
  double patience(const Appointments::Stop& stop, Stamp now) const;
  std::vector<std::size_t> mine() const;
  RowVisit next_row(const MissionInput& input) const;
  bool start_row(const MissionInput& input);
  bool go(Goal where, const Eigen::Vector2d& place, const MissionInput& input);
  void stand() {
    goal = Goal::kNone;
    path.clear();
  }
  void publish(const MissionInput& input);

  std::shared_ptr<const FleetPlan> plan;
  std::size_t self;
  MissionBoard board;
  Appointments appointments;
  MissionState state = MissionState::kDriving;
  bool begun = false;
  Stamp begun_at{};
  Eigen::Vector2d home = Eigen::Vector2d::Zero();
  Stamp listen_until{};

  std::vector<std::size_t> queue;  // rows to drive, the one under way not included
  std::optional<std::size_t> current;
  RowSet failed;
  std::vector<int> attempts;
  std::vector<bool> last_reversed;
  std::vector<std::array<double, 2>> covered;  // m of each row driven from its first and its last waypoint
  std::vector<int> failed_routes;
  std::vector<std::string> why;  // this robot gave the row up; empty: it did not
  std::vector<std::optional<Stamp>> orphan_since;
  Stamp next_takeover{};
  Stamp next_offer{};
  std::uint64_t replans = 0;

  Goal goal = Goal::kNone;
  Polyline path;
  std::uint64_t path_number = 0;
  double row_begins = 0.0;           // m along the path
  bool arrived = false;              // where it last wanted to go
  std::optional<Stamp> waits_until;  // at a stop: for the partner to come
  std::optional<Stamp> stays_until;  // at a stop: for the exchange to end
  Stamp retry_at{};
  int stuck_in_a_row = 0;
  Eigen::Vector2d stuck_at = Eigen::Vector2d::Zero();
  std::vector<Blockage> blockages;
  std::vector<Stamp> blocked_at;
  std::optional<Stamp> all_done_since;
  MissionReport report;
};

void MissionExecutive::State::begin(const MissionInput& input) {
  begun = true;
  begun_at = input.now;
  board.begin(input.now);
  const bool restarted = (input.pose.position - robot().start.position).norm() > kAtStart;
  listen_until = input.now + from_seconds(restarted ? rules().listen : 0.0);
  home = restarted ? robot().start.position : input.pose.position;
  for (const RowVisit& visit : plan->division.routes[self].visits) {
    const auto row = std::ranges::find(plan->mission.rows, visit.row, &Row::id);
    queue.push_back(static_cast<std::size_t>(row - plan->mission.rows.begin()));
  }
}

void MissionExecutive::State::release_all() {
  if (current) replans += 1;
  replans += queue.size();
  queue.clear();
  current.reset();
  appointments.drop_all();
  stand();
}

void MissionExecutive::State::row_stuck(const MissionInput& input) {
  const std::size_t row = *current;
  current.reset();
  const double length = plan->costs.along(row).length;
  double& reached = covered[row][last_reversed[row] ? 1 : 0];
  reached = std::max(reached, std::clamp(input.progress - row_begins, 0.0, length));
  const double left = length - covered[row][0] - covered[row][1];
  const bool from_both_ends = covered[row][0] > 0.0 && covered[row][1] > 0.0;
  if (left <= (1.0 - kCovered) * length || (from_both_ends && left <= kSeenAcross)) {
    board.set_done(row);
    return;
  }
  appointments.drop_all();
  if (++attempts[row] < rules().row_attempts) {
    queue.push_back(row);  // later, from the other end
    return;
  }
  char reason[160];
  std::snprintf(
      reason, sizeof reason,
      "blocked near %s m; of %.0f m it was driven %.0f m from its first and %.0f m from its last waypoint",
      text(input.pose.position).c_str(), length, covered[row][0], covered[row][1]);
  give_up(row, reason);
}

/// Others may still try the row; when enough of them gave it up, it is abandoned.
void MissionExecutive::State::give_up(std::size_t row, std::string reason) {
  failed.set(row);
  why[row] = std::move(reason);
  ++replans;
}

/// What is not on the site's plan is met only on the way; the next way leads around it.
void MissionExecutive::State::remember_blockage(const MissionInput& input) {
  double along = input.progress + kAhead;
  for (std::size_t k = 1; k < path.size(); ++k) {
    const Eigen::Vector2d d = path[k] - path[k - 1];
    if (along > d.norm() && k + 1 < path.size()) {
      along -= d.norm();
      continue;
    }
    const Eigen::Vector2d toward =
        d.norm() > 0.0 ? Eigen::Vector2d(d.normalized()) : Eigen::Vector2d(1.0, 0.0);
    const Blockage blockage{path[k - 1] + along * toward};
    // Beside the path it is somewhere else than where it thinks to be blocked.
    if ((blockage.centre - input.pose.position).norm() < blockage.radius + 0.2) return;
    if (blockages.size() == kMostBlockages) {
      blockages.erase(blockages.begin());
      blocked_at.erase(blocked_at.begin());
    }
    blockages.push_back(blockage);
    blocked_at.push_back(input.now);
    return;
  }
}

/// Around what is in the way, or else through it: it may be gone.
Result<Polyline> MissionExecutive::State::way_to(const Eigen::Vector2d& place, const MissionInput& input) {
  while (!blocked_at.empty() && input.now - blocked_at.front() > from_seconds(kForgotten)) {
    blockages.erase(blockages.begin());
    blocked_at.erase(blocked_at.begin());
  }
  auto way = plan->planner.route(input.pose.position, place, blockages);
  return way || blockages.empty() ? way : plan->planner.route(input.pose.position, place);
}

void MissionExecutive::State::look_at_follower(const MissionInput& input) {
  if (goal == Goal::kNone || input.path_number != path_number) return;
  if (input.finished) {
    stuck_in_a_row = 0;
    if (goal == Goal::kRow && current) {
      board.set_done(*current);
      current.reset();
    } else {
      arrived = true;
    }
    stand();
    return;
  }
  const double moved = (input.pose.position - stuck_at).norm();
  if (state == MissionState::kStuck && moved > kMoved) {
    // It got on again: what it gave up for this reason may be tried anew.
    state = MissionState::kDriving;
    stuck_in_a_row = 0;
    failed = RowSet(board.rows());
    std::ranges::fill(attempts, 0);
    std::ranges::fill(failed_routes, 0);
    std::ranges::fill(why, "");
  }
  if (!input.stuck) return;
  stuck_in_a_row = moved < kMoved ? stuck_in_a_row + 1 : 1;
  stuck_at = input.pose.position;
  remember_blockage(input);
  if (goal == Goal::kRow && current) row_stuck(input);
  // Near enough to talk to the others is near enough.
  const bool near = goal == Goal::kMeeting && plan->meeting &&
                    (plan->meeting->place - stuck_at).norm() < 0.5 * plan->config.meeting.c_max;
  arrived = near && stuck_in_a_row > 1;
  if (goal == Goal::kStop) end_stop(false);
  const bool elsewhere = goal == Goal::kRow || goal == Goal::kStop;  // what comes next leads another way
  retry_at = elsewhere ? input.now : input.now + from_seconds(rules().stuck_retry);
  stand();
  if (stuck_in_a_row >= rules().stuck_limit && state != MissionState::kLowBattery) {
    state = MissionState::kStuck;
    release_all();
    retry_at = input.now + from_seconds(rules().stuck_retry);
  }
}

/// Low is also who only just gets home.
void MissionExecutive::State::look_at_battery(const MissionInput& input) {
  if (!std::isfinite(input.battery) || state == MissionState::kDone) return;
  const double way = 1.4 * (input.pose.position - home).norm();
  const double share_home =
      energy_of({static_cast<float>(way), 0.0f}, robot()) / robot().battery_wh + 0.5 * rules().low_battery;
  const double mark = std::max(rules().low_battery, std::min(share_home, 0.5));
  if (state != MissionState::kLowBattery && input.battery <= mark) {
    state = MissionState::kLowBattery;
    arrived = false;
    release_all();
  } else if (state == MissionState::kLowBattery && input.battery > mark + kRecovered) {
    state = MissionState::kDriving;
    arrived = false;
    stand();
  }
}

void MissionExecutive::State::settle_claims(Stamp now) {
  std::erase_if(queue, [&](std::size_t row) {
    return board.done().has(row) || board.outclaimed(row, false, now) || failed.has(row);
  });
  // Whoever is on a row ends it, whatever others say is done: it has nodes along it before it is driven.
  if (current && board.outclaimed(*current, true, now)) {
    current.reset();
    stand();
  }
}

void MissionExecutive::State::take_orphans(Stamp now) {
  const std::vector<std::size_t> orphans = board.orphans(now);
  for (std::size_t row = 0; row < board.rows(); ++row) {
    const bool orphan = std::ranges::binary_search(orphans, row);
    if (!orphan) orphan_since[row].reset();
    if (orphan && !orphan_since[row]) orphan_since[row] = now;
  }
  if (orphans.empty() || now < next_takeover) return;
  next_takeover = now + from_seconds(kTakeoverPeriod);
  const std::vector<std::size_t> taker = board.takers(orphans, now);
  int rank = 1;  // of those who could take them
  for (std::size_t robot = 0; robot < self; ++robot) rank += board.available(robot, now) ? 1 : 0;
  for (std::size_t k = 0; k < orphans.size(); ++k) {
    if (failed.has(orphans[k])) continue;
    const bool overdue = now - *orphan_since[orphans[k]] > from_seconds(rules().orphan_wait * rank);
    if (taker[k] != self && !overdue) continue;
    queue.push_back(orphans[k]);
    ++replans;
  }
}

/// Of a plan with stops, which lets some robots be done before others on purpose.
bool MissionExecutive::State::on_schedule(Stamp now) const {
  if (!appointments.keeps_order()) return false;
  if (appointments.next()) return true;  // whoever comes to the stop counts on it
  const double end = to_seconds(now - begun_at) + board.remaining(self);
  return end < plan->division.routes[self].time + rules().offer_gain;
}

void MissionExecutive::State::give_away(const MissionInput& input) {
  if (queue.empty() || input.now < next_offer || on_schedule(input.now)) return;
  next_offer = input.now + from_seconds(rules().offer_period);
  if (!board.orphans(input.now).empty()) return;
  const double left = std::max(0.0, length_of(path) - input.progress);
  const double busy = current ? left / robot().speed : 0.0;
  const Pose2 then = current && !path.empty() ? Pose2{path.back(), input.pose.yaw} : input.pose;
  const auto given = board.to_give_away(queue, busy, then, rules().offer_gain, input.now);
  replans += given.size();
  std::erase_if(queue, [&](std::size_t row) { return std::ranges::find(given, row) != given.end(); });
}

std::vector<std::size_t> MissionExecutive::State::mine() const {
  std::vector<std::size_t> rows = queue;
  if (current) rows.push_back(*current);
  return rows;
}

void MissionExecutive::State::end_stop(bool kept) {
  kept ? appointments.kept() : appointments.dropped();
  waits_until.reset();
  stays_until.reset();
  arrived = false;
  if (goal == Goal::kStop) stand();
}

void MissionExecutive::State::look_at_appointments() {
  appointments.look(mine(), current);
  if (!appointments.next() && goal == Goal::kStop) stand();
}

/// s that it waits for the partner. If it is late itself, the partner may be as late for the same reasons.
double MissionExecutive::State::patience(const Appointments::Stop& stop, Stamp now) const {
  const double late = std::max(1.0, to_seconds(now - begun_at) / std::max(1.0, stop.arrival));
  return std::max(0.0, std::min(late, 2.0) * (stop.partner_arrival - stop.arrival)) + rules().stop_patience;
}

/// Goes to the next stop, if it is due, and waits there. False once there is none.
bool MissionExecutive::State::keep_appointment(const MissionInput& input) {
  if (!appointments.due(queue)) return false;
  const Appointments::Stop& stop = *appointments.next();
  const auto partner = appointments.partner(stop, board, input.now);
  const bool even =
      std::ranges::find(input.exchanged_with, plan->fleet[stop.partner].id) != input.exchanged_with.end();
  if (even && partner != Appointments::Partner::kComing) return end_stop(true), false;
  if (partner == Appointments::Partner::kGone) return end_stop(false), false;
  if (!arrived) {
    if (goal != Goal::kStop && !go(Goal::kStop, stop.place, input)) return end_stop(false), false;
    return true;
  }
  if (!waits_until) waits_until = input.now + from_seconds(patience(stop, input.now));
  const double apart = (board.position(stop.partner) - input.pose.position).norm();
  if (!stays_until && partner == Appointments::Partner::kDue && apart < plan->config.meeting.c_max) {
    stays_until = input.now + from_seconds(2.0 * stop.transfer + rules().stop_patience);
  }
  if (input.now > stays_until.value_or(*waits_until)) return end_stop(false), false;
  return true;
}

/// In the order of the plan if others count on it; else on the shortest way through all that are left.
RowVisit MissionExecutive::State::next_row(const MissionInput& input) const {
  if (appointments.keeps_order()) {
    const Appointments::Visit visit = appointments.next_visit(queue);
    return {plan->mission.rows[visit.row].id, visit.reversed};
  }
  const Worker me{robot(), plan->costs.from(input.pose)};
  const std::vector<Travel> to_end =
      plan->meeting ? plan->costs.to(plan->meeting->positions[self]) : std::vector<Travel>();
  DivisionConfig config = plan->config.division;
  config.method = DivisionMethod::kBalanced;
  std::vector<std::size_t> untried;
  for (const std::size_t row : queue) {
    if (attempts[row] == 0) untried.push_back(row);
  }
  const std::vector<std::size_t>& rows = untried.empty() ? queue : untried;
  const Division order = divide_rows(plan->mission, plan->costs, rows, {&me, 1}, to_end, config);
  return order.routes.front().visits.front();
}

bool MissionExecutive::State::start_row(const MissionInput& input) {
  std::ranges::sort(queue);
  const RowVisit next = next_row(input);
  const auto found = std::ranges::find(plan->mission.rows, next.row, &Row::id);
  const auto row = static_cast<std::size_t>(found - plan->mission.rows.begin());
  const bool reversed = attempts[row] > 0 ? !last_reversed[row] : next.reversed;
  const auto along = plan->planner.along(*found, reversed);
  const auto way = along ? way_to(along->front(), input) : along;
  if (!way) {
    retry_at = input.now + from_seconds(kRouteRetry);
    if (++failed_routes[row] < kMostFailedRoutes) return false;
    std::erase(queue, row);
    give_up(row, way.error().message);
    return false;
  }
  std::erase(queue, row);
  current = row;
  last_reversed[row] = reversed;
  path = *way;
  row_begins = length_of(path);
  path.insert(path.end(), along->begin(), along->end());
  goal = Goal::kRow;
  ++path_number;
  arrived = false;
  return true;
}

bool MissionExecutive::State::go(Goal where, const Eigen::Vector2d& place, const MissionInput& input) {
  const auto way = way_to(place, input);
  if (!way) {
    retry_at = input.now + from_seconds(kRouteRetry);
    return false;
  }
  path = *way;
  goal = where;
  ++path_number;
  return true;
}

/// What to do next, if nothing is under way or something better turned up.
void MissionExecutive::State::choose(const MissionInput& input) {
  if (state == MissionState::kDone) return;
  const bool settled = board.all_settled(input.now);
  const bool nothing_to_come = settled || board.nobody_left(input.now);
  if (!nothing_to_come) all_done_since.reset();
  if (nothing_to_come && !all_done_since) all_done_since = input.now;
  const double planned = plan->exchange ? std::min(plan->exchange->transfer_at_meeting, kLongest) : 0.0;
  const bool alone_too_long =
      all_done_since && input.now - *all_done_since > from_seconds(rules().meeting_timeout + planned);
  const bool may_set_out = goal == Goal::kNone && input.now >= retry_at;
  if (state == MissionState::kLowBattery) {
    if (settled && arrived && input.maps_exchanged) state = MissionState::kDone;
    if (goal == Goal::kNone && alone_too_long) state = MissionState::kDone;
    if (state != MissionState::kDone && may_set_out && !arrived) go(Goal::kHome, home, input);
    return;
  }
  if (state == MissionState::kStuck) {
    if (may_set_out) go(Goal::kMeeting, plan->meeting ? plan->meeting->positions[self] : home, input);
    if (alone_too_long) state = MissionState::kDone;
    return;
  }
  if (current) {
    state = MissionState::kDriving;
    return;
  }
  if (keep_appointment(input)) {
    state = MissionState::kDriving;
    return;
  }
  if (!queue.empty()) {
    state = MissionState::kDriving;
    if (input.now >= retry_at) start_row(input);
    return;
  }
  if (plan->meeting && !arrived) {
    state = MissionState::kDriving;
    if (goal != Goal::kMeeting && alone_too_long) state = MissionState::kDone;  // it found no way there
    if (goal != Goal::kMeeting && input.now >= retry_at && state != MissionState::kDone)
      go(Goal::kMeeting, plan->meeting->positions[self], input);
    return;
  }
  state = plan->meeting ? MissionState::kMeeting : MissionState::kDriving;
  if (settled && (!plan->meeting || input.maps_exchanged || alone_too_long)) state = MissionState::kDone;
}

void MissionExecutive::State::publish(const MissionInput& input) {
  report.agent = robot().id;
  report.stamp = input.now;
  report.state = state;
  if (input.pose.position.allFinite()) report.position = input.pose.position;
  report.battery = input.battery;
  report.current = current ? static_cast<std::uint32_t>(*current) : MissionReport::kNoRow;
  report.done = board.done();
  report.claimed = RowSet(board.rows());
  for (const std::size_t row : queue) report.claimed.set(row);
  if (current) report.claimed.set(*current);
  report.failed = failed;
  board.set_own(report);
}

MissionExecutive::MissionExecutive(std::unique_ptr<State> state) : state_(std::move(state)) {}
MissionExecutive::~MissionExecutive() = default;
MissionExecutive::MissionExecutive(MissionExecutive&&) noexcept = default;
MissionExecutive& MissionExecutive::operator=(MissionExecutive&&) noexcept = default;

Result<MissionExecutive> MissionExecutive::create(std::shared_ptr<const FleetPlan> plan,
                                                  const AgentId& self) {
  const auto index = plan->find(self);
  if (!index) return failure("mission: robot " + self.str() + " is not in the fleet");
  return MissionExecutive(std::make_unique<State>(std::move(plan), *index));
}

Result<MissionExecutive> MissionExecutive::create(Mission mission, const AgentId& self,
                                                  std::span<const RobotAbility> fleet,
                                                  const MissionConfig& config) {
  auto plan = plan_fleet(std::move(mission), fleet, config);
  if (!plan) return tl::unexpected(plan.error());
  return create(std::move(*plan), self);
}

void MissionExecutive::on_report(const MissionReport& report, Stamp now) { state_->board.hear(report, now); }

MissionAction MissionExecutive::update(const MissionInput& input) {
  State& s = *state_;
  if (!input.pose.position.allFinite() || !std::isfinite(input.pose.yaw)) {
    return {MissionAction::Kind::kHold, {}, s.path_number};
  }
  if (!s.begun) s.begin(input);
  s.board.set_surveyed(input.surveyed);
  s.look_at_follower(input);
  s.look_at_battery(input);
  s.settle_claims(input.now);
  s.publish(input);
  if (input.now < s.listen_until) return {MissionAction::Kind::kHold, {}, s.path_number};
  if (s.board.available(s.self, input.now)) {
    s.take_orphans(input.now);
    s.give_away(input);
  }
  s.look_at_appointments();
  s.choose(input);
  s.publish(input);
  if (s.state == MissionState::kDone) return {MissionAction::Kind::kDone, {}, s.path_number};
  if (s.goal == Goal::kNone) return {MissionAction::Kind::kHold, {}, s.path_number};
  return {MissionAction::Kind::kFollow, s.path, s.path_number};
}

MissionReport MissionExecutive::report() const { return state_->report; }

MissionExecutive::Status MissionExecutive::status() const {
  const State& s = *state_;
  const Stamp now = s.report.stamp;
  Status status;
  status.state = s.state;
  status.rows = s.board.rows();
  status.done = s.board.done().count();
  status.mine = s.report.claimed.count();
  status.replans = s.replans;
  status.stops_kept = s.appointments.count_kept();
  status.stops_dropped = s.appointments.count_dropped();
  for (std::size_t row = 0; row < s.board.rows(); ++row) {
    if (s.board.done().has(row)) continue;
    if (!s.board.abandoned(row, now) && s.state != MissionState::kDone) continue;
    status.abandoned.push_back({s.plan->mission.rows[row].id, s.why[row]});
  }
  for (std::size_t robot = 0; robot < s.board.robots(); ++robot) {
    if (robot == s.self) continue;
    if (s.board.lost(robot, now)) status.lost.push_back(s.plan->fleet[robot].id);
    if (s.board.available(robot, now)) status.expected.push_back(s.plan->fleet[robot].id);
  }
  return status;
}

const FleetPlan& MissionExecutive::plan() const { return *state_->plan; }

}  // namespace fleetmap::planning
