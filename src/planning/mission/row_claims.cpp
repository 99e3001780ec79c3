#include "mission/row_claims.hpp"

#include <algorithm>
#include <utility>

namespace fleetmap::planning {
namespace {

constexpr double kTakeoverPeriod = 5.0;  // s between two divisions of the orphans

}  // namespace

RowClaims::RowClaims(std::shared_ptr<const FleetPlan> plan, std::size_t self)
    : plan_(std::move(plan)), self_(self), orphan_since_(plan_->mission.rows.size()) {}

void RowClaims::begin() {
  for (const RowVisit& visit : plan_->division.routes[self_].visits) {
    const auto row = std::ranges::find(plan_->mission.rows, visit.row, &Row::id);
    queue_.push_back(static_cast<std::size_t>(row - plan_->mission.rows.begin()));
  }
}

bool RowClaims::drop_lost(const MissionBoard& board, const RowSet& abandoned, Stamp now) {
  std::erase_if(queue_, [&](std::size_t row) {
    return board.done().has(row) || board.lost_claim(row, false, now) || abandoned.has(row) ||
           board.barred(self_, row, now);
  });
  if (!current_) return false;
  if (!board.lost_claim(*current_, true, now) && !board.barred(self_, *current_, now)) return false;
  current_.reset();
  return true;
}

void RowClaims::take_ordered(const MissionBoard& board, const RowSet& abandoned, Stamp now) {
  for (std::size_t row = 0; row < board.rows(); ++row) {
    if (board.receiver(row) != self_ || board.finished(row, now)) continue;
    if (abandoned.has(row) || current_ == row || std::ranges::find(queue_, row) != queue_.end()) continue;
    queue_.push_back(row);
    ++changes_;
  }
}

void RowClaims::take_orphans(const MissionBoard& board, const RowSet& abandoned, Stamp now) {
  const std::vector<std::size_t> orphans = board.orphans(now);
  for (std::size_t row = 0; row < board.rows(); ++row) {
    const bool orphan = std::ranges::binary_search(orphans, row);
    if (!orphan) orphan_since_[row].reset();
    if (orphan && !orphan_since_[row]) orphan_since_[row] = now;
  }
  if (orphans.empty() || now < next_takeover_) return;
  next_takeover_ = now + from_seconds(kTakeoverPeriod);
  const std::vector<std::size_t> taker = board.takers(orphans, now);
  int rank = 1;  // of those who could take them
  for (std::size_t robot = 0; robot < self_; ++robot) rank += board.available(robot, now) ? 1 : 0;
  const Duration patience = from_seconds(plan_->config.executive.orphan_wait * rank);
  for (std::size_t k = 0; k < orphans.size(); ++k) {
    if (abandoned.has(orphans[k]) || board.barred(self_, orphans[k], now)) continue;
    const bool overdue = now - *orphan_since_[orphans[k]] > patience;
    if (taker[k] != self_ && !overdue) continue;
    queue_.push_back(orphans[k]);
    ++changes_;
  }
}

void RowClaims::give_away(const MissionBoard& board, double busy, const Pose2& then, Stamp now) {
  const ExecutiveConfig& rules = plan_->config.executive;
  if (queue_.empty() || now < next_offer_) return;
  next_offer_ = now + from_seconds(rules.offer_period);
  if (!board.orphans(now).empty()) return;
  const auto offered = board.to_give_away(queue_, busy, then, rules.offer_gain, now);
  changes_ += offered.size();
  std::erase_if(queue_, [&](std::size_t row) { return std::ranges::find(offered, row) != offered.end(); });
}

void RowClaims::release_all() {
  changes_ += all().size();
  queue_.clear();
  current_.reset();
}

void RowClaims::start(std::size_t row) {
  drop(row);
  current_ = row;
}

void RowClaims::sort() { std::ranges::sort(queue_); }

std::vector<std::size_t> RowClaims::all() const {
  std::vector<std::size_t> rows = queue_;
  if (current_) rows.push_back(*current_);
  return rows;
}

RowSet RowClaims::as_set() const {
  RowSet rows(plan_->mission.rows.size());
  for (const std::size_t row : all()) rows.set(row);
  return rows;
}

}  // namespace fleetmap::planning
