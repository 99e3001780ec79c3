#include "mission/mission_board.hpp"

#include <algorithm>
#include <cmath>

namespace fleetmap::planning {
namespace {

/// Robots that tried a row from both ends until nobody tries it any more.
constexpr std::size_t kRefusals = 2;

/// Replanning must be quick and is repeated anyway.
DivisionConfig quick(const DivisionConfig& config) {
  DivisionConfig fast = config;
  fast.method = DivisionMethod::kBalanced;
  fast.search_rounds = std::min(config.search_rounds, 10);
  return fast;
}

}  // namespace

MissionBoard::MissionBoard(std::shared_ptr<const FleetPlan> plan, std::size_t self)
    : plan_(std::move(plan)),
      self_(self),
      peers_(plan_->fleet.size()),
      driven_(plan_->mission.rows.size()),
      reported_(plan_->mission.rows.size()),
      surveyed_(plan_->mission.rows.size()),
      done_(plan_->mission.rows.size()) {
  for (const RobotRoute& route : plan_->division.routes) {
    RowSet mine(rows());
    for (const RowVisit& visit : route.visits) {
      const auto row = std::ranges::find(plan_->mission.rows, visit.row, &Row::id);
      mine.set(static_cast<std::size_t>(row - plan_->mission.rows.begin()));
    }
    planned_.push_back(mine);
  }
  own_.from = plan_->fleet[self_].id;
  own_.claimed = planned_[self_];
}

void MissionBoard::hear(const MissionReport& report, Stamp now) {
  const auto robot = plan_->find(report.from);
  if (!robot || *robot == self_ || !report.position.allFinite()) return;
  MissionReport sound = report;
  sound.done = RowSet(rows(), report.done.bytes());
  sound.claimed = RowSet(rows(), report.claimed.bytes());
  sound.failed = RowSet(rows(), report.failed.bytes());
  reported_ |= sound.done;
  Peer& peer = peers_[*robot];
  // A clock that was set back must not silence a robot for good.
  const bool forgotten = now - peer.heard > from_seconds(plan_->config.executive.lost_after);
  if (!peer.last || report.stamp > peer.last->stamp || forgotten) {
    peer.last = std::move(sound);
    peer.heard = now;
  }
  resolve_done(now);
}

void MissionBoard::set_done(std::size_t row) {
  driven_.set(row);
  done_.set(row);
}

void MissionBoard::set_surveyed(const RowSet& rows, Stamp now) {
  surveyed_ = RowSet(this->rows(), rows.bytes());
  resolve_done(now);
}

void MissionBoard::resolve_done(Stamp now) {
  done_ = reported_;
  done_ &= surveyed_;
  done_ |= driven_;
  for (std::size_t robot = 0; robot < peers_.size(); ++robot) {
    if (!peers_[robot].last || lost(robot, now)) continue;
    RowSet own = peers_[robot].last->done;
    own &= planned_[robot];
    done_ |= own;
  }
}

std::vector<std::pair<std::size_t, std::size_t>> MissionBoard::unconfirmed() const {
  std::vector<std::pair<std::size_t, std::size_t>> found;
  if (surveyed_.none()) return found;
  for (std::size_t robot = 0; robot < robots(); ++robot) {
    for (std::size_t row = 0; row < rows(); ++row) {
      if (!planned_[robot].has(row) || !done_.has(row) || surveyed_.has(row) || driven_.has(row)) continue;
      found.emplace_back(row, robot);
    }
  }
  return found;
}

const MissionReport* MissionBoard::report_of(std::size_t robot) const {
  if (robot == self_) return &own_;
  return peers_[robot].last ? &*peers_[robot].last : nullptr;
}

bool MissionBoard::lost(std::size_t robot, Stamp now) const {
  if (robot == self_) return false;
  const Stamp since = peers_[robot].last ? peers_[robot].heard : begun_;
  return now - since > from_seconds(plan_->config.executive.lost_after);
}

MissionState MissionBoard::state(std::size_t robot, Stamp now) const {
  const MissionReport* report = report_of(robot);
  if (report && report->state == MissionState::kDone) return MissionState::kDone;
  if (lost(robot, now)) return MissionState::kLost;
  return report ? report->state : MissionState::kDriving;
}

bool MissionBoard::available(std::size_t robot, Stamp now) const {
  const MissionState now_is = state(robot, now);
  return now_is == MissionState::kDriving || now_is == MissionState::kMeeting;
}

bool MissionBoard::claims(std::size_t robot, std::size_t row) const {
  const MissionReport* report = report_of(robot);
  return report ? report->claimed.has(row) || report->current == row : planned_[robot].has(row);
}

bool MissionBoard::under_way(std::size_t robot, std::size_t row) const {
  const MissionReport* report = report_of(robot);
  return report && report->current == row;
}

bool MissionBoard::failed(std::size_t robot, std::size_t row) const {
  const MissionReport* report = report_of(robot);
  return report && report->failed.has(row);
}

Eigen::Vector2d MissionBoard::position(std::size_t robot) const {
  const MissionReport* report = report_of(robot);
  return report ? report->position : plan_->fleet[robot].start.position;
}

bool MissionBoard::idle(std::size_t robot, Stamp now) const {
  const MissionReport* report = report_of(robot);
  return report && available(robot, now) && report->claimed.none() &&
         report->current == MissionReport::kNoRow;
}

void MissionBoard::set_row_orders(const std::vector<messages::RowOrder>& orders) {
  handovers_.clear();
  for (const messages::RowOrder& order : orders) {
    const auto row = std::ranges::find(plan_->mission.rows, order.row, &Row::id);
    const auto by = plan_->find(order.robot);
    const auto to = order.to.empty() ? std::nullopt : plan_->find(order.to);
    if (row == plan_->mission.rows.end() || !by || (!to && !order.to.empty())) continue;
    handovers_[static_cast<std::size_t>(row - plan_->mission.rows.begin())] = {*by, to};
  }
}

std::optional<std::size_t> MissionBoard::receiver(std::size_t row) const {
  const auto handover = handovers_.find(row);
  return handover == handovers_.end() ? std::nullopt : handover->second.to;
}

bool MissionBoard::barred(std::size_t robot, std::size_t row, Stamp now) const {
  const auto handover = handovers_.find(row);
  if (handover == handovers_.end() || handover->second.to || handover->second.by != robot) return false;
  for (std::size_t other = 0; other < robots(); ++other) {
    if (other != robot && can_drive(other, row, now)) return true;
  }
  return false;
}

bool MissionBoard::lost_claim(std::size_t row, bool ours_under_way, Stamp now) const {
  for (std::size_t robot = 0; robot < robots(); ++robot) {
    if (robot == self_ || !peers_[robot].last || !available(robot, now) || !claims(robot, row)) continue;
    if (const auto assignee = receiver(row); assignee == self_ || assignee == robot) {
      if (assignee == robot) return true;
      continue;
    }
    const bool theirs_under_way = under_way(robot, row);
    if (theirs_under_way != ours_under_way ? theirs_under_way : robot < self_) return true;
  }
  return false;
}

bool MissionBoard::abandoned(std::size_t row, Stamp now) const {
  std::size_t left = 0;
  std::size_t refused = 0;
  for (std::size_t robot = 0; robot < robots(); ++robot) {
    if (!available(robot, now)) continue;
    ++left;
    refused += failed(robot, row) ? 1 : 0;
  }
  return left > 0 && refused >= std::min(left, kRefusals);
}

bool MissionBoard::nobody_left(Stamp now) const {
  for (std::size_t robot = 0; robot < robots(); ++robot) {
    if (available(robot, now)) return false;
  }
  return true;
}

bool MissionBoard::all_finished(Stamp now) const {
  for (std::size_t row = 0; row < rows(); ++row) {
    if (!finished(row, now)) return false;
  }
  return true;
}

std::vector<std::size_t> MissionBoard::orphans(Stamp now) const {
  std::vector<std::size_t> found;
  for (std::size_t row = 0; row < rows(); ++row) {
    if (finished(row, now) || claims(self_, row)) continue;
    bool taken = false;
    for (std::size_t robot = 0; robot < robots() && !taken; ++robot) {
      taken = robot != self_ && available(robot, now) && claims(robot, row);
    }
    if (!taken) found.push_back(row);
  }
  return found;
}

double MissionBoard::remaining(std::size_t robot) const {
  const RobotAbility& ability = plan_->fleet[robot];
  double sum = 0.0;
  for (std::size_t row = 0; row < rows(); ++row) {
    if (done_.has(row) || !claims(robot, row)) continue;
    const double between = 10.0;  // s, to turn into the next row
    sum += time_of(plan_->costs.along(row), ability) * (under_way(robot, row) ? 0.5 : 1.0) + between;
  }
  return sum;
}

std::vector<std::size_t> MissionBoard::takers(const std::vector<std::size_t>& orphans, Stamp now) const {
  std::vector<std::size_t> crew;
  std::vector<Worker> workers;
  for (std::size_t robot = 0; robot < robots(); ++robot) {
    if (!available(robot, now)) continue;
    crew.push_back(robot);
    workers.push_back({plan_->fleet[robot], plan_->costs.from({position(robot), 0.0}), remaining(robot)});
  }
  std::vector<std::size_t> taker(orphans.size(), robots());
  if (crew.empty()) return taker;
  const Division division =
      divide_rows(plan_->mission, plan_->costs, orphans, workers, {}, quick(plan_->config.division));
  for (std::size_t k = 0; k < orphans.size(); ++k) {
    const RowId id = plan_->mission.rows[orphans[k]].id;
    for (std::size_t w = 0; w < crew.size(); ++w) {
      const auto& visits = division.routes[w].visits;
      if (std::ranges::find(visits, id, &RowVisit::row) != visits.end()) taker[k] = crew[w];
    }
    const auto may_take = [&](std::size_t r) {
      return !failed(r, orphans[k]) && !barred(r, orphans[k], now);
    };
    if (taker[k] < robots() && may_take(taker[k])) continue;
    const auto other = std::ranges::find_if(crew, may_take);
    taker[k] = other == crew.end() ? robots() : *other;
  }
  return taker;
}

std::vector<std::size_t> MissionBoard::to_give_away(const std::vector<std::size_t>& mine, double busy,
                                                    const Pose2& pose, double gain, Stamp now) const {
  std::vector<Worker> workers{{plan_->fleet[self_], plan_->costs.from(pose), busy}};
  std::vector<std::size_t> helpers;
  const double own = remaining(self_);
  for (std::size_t robot = 0; robot < robots(); ++robot) {
    if (robot == self_) continue;
    if (idle(robot, now)) {
      helpers.push_back(robot);
      workers.push_back({plan_->fleet[robot], plan_->costs.from({position(robot), 0.0})});
    } else if (available(robot, now)) {
      const double theirs = remaining(robot);  // who has most left gives first
      if (theirs > own || (theirs == own && robot < self_)) return {};
    }
  }
  if (helpers.empty()) return {};
  std::vector<std::size_t> rows;
  for (const std::size_t row : mine) {
    const auto refuses = [&](std::size_t r) { return failed(r, row) || barred(r, row, now); };
    if (receiver(row) != self_ && std::ranges::none_of(helpers, refuses)) rows.push_back(row);
  }
  const DivisionConfig config = quick(plan_->config.division);
  const Division alone =
      divide_rows(plan_->mission, plan_->costs, rows, std::span(workers).first(1), {}, config);
  const Division shared = divide_rows(plan_->mission, plan_->costs, rows, workers, {}, config);
  if (alone.makespan - shared.makespan < gain) return {};
  std::vector<std::size_t> rejected;
  const auto& kept = shared.routes.front().visits;
  for (const std::size_t row : rows) {
    const RowId id = plan_->mission.rows[row].id;
    if (std::ranges::find(kept, id, &RowVisit::row) == kept.end()) rejected.push_back(row);
  }
  return rejected;
}

}  // namespace fleetmap::planning
