#include "mission/appointments.hpp"

#include <algorithm>

namespace fleetmap::planning {

Appointments::Appointments(const FleetPlan& plan, std::size_t self) : self_(self) {
  for (const RobotRoute& route : plan.division.routes) {
    std::vector<Visit> visits;
    for (const RowVisit& visit : route.visits) {
      const auto row = std::ranges::find(plan.mission.rows, visit.row, &Row::id);
      visits.push_back({static_cast<std::size_t>(row - plan.mission.rows.begin()), visit.reversed});
    }
    planned_.push_back(std::move(visits));
  }
  if (!plan.exchange) return;
  as_planned_ = !plan.exchange->stops.empty();
  for (const Detour& detour : plan.exchange->stops) {
    for (std::size_t part = 0; part < 2; ++part) {
      const Detour::Part& own = detour.parts[part];
      const Detour::Part& other = detour.parts[1 - part];
      if (own.robot != self) continue;
      stops_.push_back({other.robot, own.after, other.after, own.place, own.arrival, other.arrival,
                        detour.leave - std::max(own.arrival, other.arrival)});
    }
  }
  std::ranges::sort(stops_, {}, &Stop::after);
}

void Appointments::update(std::span<const std::size_t> mine, const std::optional<std::size_t>& current) {
  if (!as_planned_) return;
  const std::vector<Visit>& visits = planned_[self_];
  const std::size_t driven = visits.size() - std::min(visits.size(), mine.size());
  bool as_planned = mine.size() <= visits.size() && (!current || visits[driven].row == *current);
  for (std::size_t k = driven; k < visits.size() && as_planned; ++k) {
    as_planned = std::ranges::find(mine, visits[k].row) != mine.end();
  }
  if (!as_planned) return drop_all();
  const auto begun = driven + (current ? 1 : 0);
  while (!stops_.empty() && stops_.front().after < begun) dropped();
}

bool Appointments::due(std::span<const std::size_t> mine) const {
  return !stops_.empty() && mine.size() + stops_.front().after == planned_[self_].size();
}

Appointments::Partner Appointments::partner(const Stop& stop, const MissionBoard& board, Stamp now) const {
  if (!board.available(stop.partner, now)) return Partner::kGone;
  const std::vector<Visit>& visits = planned_[stop.partner];
  std::size_t claimed = 0;
  for (std::size_t row = 0; row < board.rows(); ++row) claimed += board.claims(stop.partner, row) ? 1 : 0;
  if (claimed > visits.size()) return Partner::kGone;
  const std::size_t driven = visits.size() - claimed;
  for (std::size_t k = driven; k < visits.size(); ++k) {
    if (!board.claims(stop.partner, visits[k].row)) return Partner::kGone;
    if (k > driven && board.under_way(stop.partner, visits[k].row)) return Partner::kGone;
  }
  if (driven < stop.partner_after) return Partner::kComing;
  const bool drives_on = driven < visits.size() ? board.under_way(stop.partner, visits[driven].row)
                                                : board.state(stop.partner, now) == MissionState::kMeeting;
  return driven == stop.partner_after && !drives_on ? Partner::kDue : Partner::kGone;
}

Appointments::Visit Appointments::next_visit(std::span<const std::size_t> mine) const {
  return planned_[self_][planned_[self_].size() - mine.size()];
}

void Appointments::drop_all() {
  as_planned_ = false;
  dropped_ += stops_.size();
  stops_.clear();
}

}  // namespace fleetmap::planning
