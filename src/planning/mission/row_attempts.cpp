#include "mission/row_attempts.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace fleetmap::planning {
namespace {

constexpr double kDrivenShare = 0.9;   // share of a row that counts as driven
constexpr double kInspectedGap = 8.0;  // m between the two places at which it was stopped, seen from both
constexpr int kMaxFailedRoutes = 4;    // to one row, until the robot gives it up

}  // namespace

RowAttempts::RowAttempts(std::size_t rows)
    : abandoned_(rows),
      attempts_(rows, 0),
      last_reversed_(rows, false),
      covered_(rows, {0.0, 0.0}),
      failed_routes_(rows, 0),
      reasons_(rows) {}

bool RowAttempts::next_reversed(std::size_t row, bool planned) const {
  return tried(row) ? !last_reversed_[row] : planned;
}

RowAttempts::Outcome RowAttempts::blocked(std::size_t row, double driven, double length,
                                          const Eigen::Vector2d& position, int max_attempts) {
  auto& [from_first, from_last] = covered_[row];
  double& reached = last_reversed_[row] ? from_last : from_first;
  reached = std::max(reached, std::clamp(driven, 0.0, length));
  const double left = length - from_first - from_last;
  const bool from_both_ends = from_first > 0.0 && from_last > 0.0;
  if (left <= (1.0 - kDrivenShare) * length || (from_both_ends && left <= kInspectedGap))
    return Outcome::kDriven;
  if (++attempts_[row] < max_attempts) return Outcome::kRetry;
  char reason[192];
  std::snprintf(reason, sizeof reason,
                "blocked near (%.1f, %.1f) m; of %.0f m it was driven %.0f m from its first and %.0f m from "
                "its last waypoint",
                position.x(), position.y(), length, from_first, from_last);
  give_up(row, reason);
  return Outcome::kAbandoned;
}

bool RowAttempts::unreachable(std::size_t row, const std::string& reason) {
  if (++failed_routes_[row] < kMaxFailedRoutes) return false;
  give_up(row, reason);
  return true;
}

void RowAttempts::give_up(std::size_t row, std::string reason) {
  abandoned_.set(row);
  reasons_[row] = std::move(reason);
  ++times_abandoned_;
}

void RowAttempts::reset() {
  abandoned_ = RowSet(attempts_.size());
  std::ranges::fill(attempts_, 0);
  std::ranges::fill(failed_routes_, 0);
  std::ranges::fill(reasons_, "");
}

}  // namespace fleetmap::planning
