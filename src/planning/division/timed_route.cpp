#include "division/timed_route.hpp"

#include <algorithm>
#include <limits>

namespace fleetmap::planning {
namespace {

std::size_t entry(std::size_t row, std::size_t direction) { return 2 * row + direction; }
std::size_t exit_of(std::size_t row, std::size_t direction) { return 2 * row + 1 - direction; }

}  // namespace

void TimedRoute::set_budget() {
  per_metre_ = 1.0 / worker_->ability.speed;
  per_radian_ = 1.0 / worker_->ability.yaw_rate;
  // Charged as if it drove all the time: turning on the spot covers no distance, so this is on the safe side.
  const double watts =
      worker_->ability.power_idle_w + 3600.0 * worker_->ability.energy_per_metre_wh * worker_->ability.speed;
  budget_ = watts > 0.0 ? worker_->busy + worker_->energy_wh * 3600.0 / watts
                        : std::numeric_limits<double>::infinity();
}

void TimedRoute::assign(std::vector<std::size_t> rows) {
  set_budget();
  rows_ = std::move(rows);
  front_.resize(rows_.size());
  back_.resize(rows_.size());
  for (std::size_t k = 0; k < rows_.size(); ++k) front_[k] = entered(k, rows_[k]);
  for (std::size_t k = rows_.size(); k-- > 0;) {
    for (std::size_t d = 0; d < 2; ++d) {
      const std::size_t out = exit_of(rows_[k], d);
      double rest = ending(out);
      if (k + 1 < rows_.size()) {
        const std::size_t next = rows_[k + 1];
        rest = std::min(seconds(costs_->between(out, entry(next, 0))) + back_[k + 1][0],
                        seconds(costs_->between(out, entry(next, 1))) + back_[k + 1][1]);
      }
      back_[k][d] = along(rows_[k]) + rest;
    }
  }
  time_ = worker_->busy;
  if (rows_.empty()) return;
  time_ = std::numeric_limits<double>::infinity();
  for (std::size_t d = 0; d < 2; ++d) {
    time_ = std::min(time_, worker_->busy + seconds(worker_->from[entry(rows_[0], d)]) + back_[0][d]);
  }
}

/// Times at which `row` is driven as the k-th, after the first k rows.
TimedRoute::Pair TimedRoute::entered(std::size_t k, std::size_t row) const {
  if (k > 0) return stepped(front_[k - 1], rows_[k - 1], row);
  Pair times;
  for (std::size_t d = 0; d < 2; ++d) {
    times[d] = worker_->busy + seconds(worker_->from[entry(row, d)]) + along(row);
  }
  return times;
}

TimedRoute::Pair TimedRoute::stepped(const Pair& front, std::size_t last, std::size_t row) const {
  Pair times;
  for (std::size_t d = 0; d < 2; ++d) {
    times[d] = along(row) + std::min(front[0] + seconds(costs_->between(exit_of(last, 0), entry(row, d))),
                                     front[1] + seconds(costs_->between(exit_of(last, 1), entry(row, d))));
  }
  return times;
}

/// s of the whole route whose front ends with `row`, followed by the rows from place `next` on.
double TimedRoute::closed(const Pair& front, std::size_t row, std::size_t next) const {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t d = 0; d < 2; ++d) {
    const std::size_t out = exit_of(row, d);
    if (next == rows_.size()) {
      best = std::min(best, front[d] + ending(out));
      continue;
    }
    for (std::size_t e = 0; e < 2; ++e) {
      best = std::min(best, front[d] + seconds(costs_->between(out, entry(rows_[next], e))) + back_[next][e]);
    }
  }
  return best;
}

double TimedRoute::time_without(std::size_t k) const {
  if (rows_.size() == 1) return worker_->busy;
  if (k > 0) return closed(front_[k - 1], rows_[k - 1], k + 1);
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t d = 0; d < 2; ++d) {
    best = std::min(best, worker_->busy + seconds(worker_->from[entry(rows_[1], d)]) + back_[1][d]);
  }
  return best;
}

double TimedRoute::time_with(std::size_t k, std::size_t row) const { return closed(entered(k, row), row, k); }

double TimedRoute::time_replaced(std::size_t k, std::size_t row) const {
  return closed(entered(k, row), row, k + 1);
}

double TimedRoute::time_joined(std::size_t kept, const TimedRoute& other, std::size_t from) const {
  if (from == other.rows_.size()) {
    return kept == 0 ? worker_->busy
                     : std::min(front_[kept - 1][0] + ending(exit_of(rows_[kept - 1], 0)),
                                front_[kept - 1][1] + ending(exit_of(rows_[kept - 1], 1)));
  }
  // The other's times from the back are those of its own speed, so the tail is driven anew.
  Pair times = entered(kept, other.rows_[from]);
  for (std::size_t k = from + 1; k < other.rows_.size(); ++k) {
    times = stepped(times, other.rows_[k - 1], other.rows_[k]);
  }
  const std::size_t last = other.rows_.back();
  return std::min(times[0] + ending(exit_of(last, 0)), times[1] + ending(exit_of(last, 1)));
}

double TimedRoute::time_of_order(std::span<const std::size_t> rows) const {
  if (rows.empty()) return worker_->busy;
  Pair times = entered(0, rows[0]);
  for (std::size_t k = 1; k < rows.size(); ++k) times = stepped(times, rows[k - 1], rows[k]);
  return std::min(times[0] + ending(exit_of(rows.back(), 0)), times[1] + ending(exit_of(rows.back(), 1)));
}

std::vector<bool> TimedRoute::directions() const {
  std::vector<bool> reversed(rows_.size());
  double arrival[2] = {0.0, 0.0};
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    for (std::size_t d = 0; d < 2; ++d) {
      const Travel way =
          k == 0 ? worker_->from[entry(rows_[0], d)]
                 : costs_->between(exit_of(rows_[k - 1], reversed[k - 1] ? 1 : 0), entry(rows_[k], d));
      arrival[d] = seconds(way) + back_[k][d];
    }
    reversed[k] = arrival[1] < arrival[0];
  }
  return reversed;
}

Travel TimedRoute::travel() const {
  Travel sum{0.0f, 0.0f};
  const std::vector<bool> reversed = directions();
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const std::size_t in = entry(rows_[k], reversed[k] ? 1 : 0);
    sum = sum +
          (k == 0 ? worker_->from[in] : costs_->between(exit_of(rows_[k - 1], reversed[k - 1] ? 1 : 0), in));
    sum = sum + costs_->along(rows_[k]);
  }
  if (!rows_.empty() && !to_end_.empty()) {
    sum = sum + to_end_[exit_of(rows_.back(), reversed.back() ? 1 : 0)];
  }
  return sum;
}

}  // namespace fleetmap::planning
