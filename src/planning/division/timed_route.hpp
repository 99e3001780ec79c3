#pragma once

#include <array>
#include <span>
#include <vector>

#include "fleetmap/planning/division/division.hpp"

namespace fleetmap::planning {

/// Rows of one worker in order, with the best direction of each: kept as the times of the two directions from
/// the front and from the back, so that a change at any place is priced in constant time.
class TimedRoute {
 public:
  TimedRoute(const TravelCosts& costs, std::span<const Travel> to_end, const Worker& worker)
      : costs_(&costs), to_end_(to_end), worker_(&worker) {
    assign({});
  }

  void assign(std::vector<std::size_t> rows);
  const std::vector<std::size_t>& rows() const { return rows_; }
  /// s, until the last row is driven and the end is reached.
  double time() const { return time_; }
  /// s of time() beyond what the battery allows.
  double overtime() const { return overtime_of(time_); }
  double overtime_of(double time) const { return time > budget_ ? time - budget_ : 0.0; }

  double time_without(std::size_t k) const;
  /// `row` put before place k.
  double time_with(std::size_t k, std::size_t row) const;
  double time_replaced(std::size_t k, std::size_t row) const;
  /// The first `kept` rows of this one, then those of `other` from `from` on.
  double time_joined(std::size_t kept, const TimedRoute& other, std::size_t from) const;
  /// Time of the rows in any order, s.
  double time_of_order(std::span<const std::size_t> rows) const;
  /// Best direction of each row: true is reversed.
  std::vector<bool> directions() const;
  Travel travel() const;

 private:
  using Pair = std::array<double, 2>;  // by direction
  double along(std::size_t row) const { return seconds(costs_->along(row)); }
  double seconds(const Travel& t) const { return t.length * per_metre_ + t.turn * per_radian_; }
  Pair entered(std::size_t k, std::size_t row) const;
  Pair stepped(const Pair& front, std::size_t last, std::size_t row) const;
  double closed(const Pair& front, std::size_t row, std::size_t next) const;
  double ending(std::size_t exit) const { return to_end_.empty() ? 0.0 : seconds(to_end_[exit]); }
  void set_budget();

  const TravelCosts* costs_;
  std::span<const Travel> to_end_;
  const Worker* worker_;
  double per_metre_ = 0.0;
  double per_radian_ = 0.0;
  double budget_ = 0.0;
  std::vector<std::size_t> rows_;
  std::vector<Pair> front_;  // s, row k driven in direction d
  std::vector<Pair> back_;   // s, from entering row k in direction d to the end
  double time_ = 0.0;
};

}  // namespace fleetmap::planning
