#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "fleetmap/planning/mission/fleet_plan.hpp"
#include "mission/mission_board.hpp"

namespace fleetmap::planning {

/// The stops that the plan has for one robot. They are valid while the robot and its partner drive the rows
/// of the plan: a robot that takes or gives rows drops all of its stops, and its partners detect that in the
/// rows that it claims.
class Appointments {
 public:
  Appointments(const FleetPlan& plan, std::size_t self);

  struct Stop {
    std::size_t partner = 0;
    std::size_t after = 0;          ///< own rows driven before
    std::size_t partner_after = 0;  ///< rows that the partner drives before
    Eigen::Vector2d place = Eigen::Vector2d::Zero();
    double arrival = 0.0;          ///< s, planned
    double partner_arrival = 0.0;  ///< s, planned
    double transfer = 0.0;         ///< s, planned, from when both are there
  };
  enum class Partner : std::uint8_t {
    kComing,  ///< still has rows to drive before
    kDue,     ///< on its way to the stop, or there
    kGone,    ///< has gone on, or changed its rows, is lost or can't drive
  };

  /// `mine`: rows that this robot still has, with the one under way. Drops all stops if they are not what the
  /// plan has left for it, and else those that lie behind.
  void update(std::span<const std::size_t> mine, const std::optional<std::size_t>& current);
  /// The next stop, if there is one.
  const Stop* next() const { return stops_.empty() ? nullptr : &stops_.front(); }
  /// The next stop comes before any other row.
  bool due(std::span<const std::size_t> mine) const;
  Partner partner(const Stop& stop, const MissionBoard& board, Stamp now) const;
  /// The plan has stops, and this robot's rows are those of the plan: then it drives them in the plan's
  /// order, on which the forecast of who meets whom rests.
  bool keeps_order() const { return as_planned_; }
  /// The next row and its direction in this order; there is one.
  struct Visit {
    std::size_t row = 0;
    bool reversed = false;
  };
  Visit next_visit(std::span<const std::size_t> mine) const;

  void kept() { ++kept_, stops_.erase(stops_.begin()); }
  void dropped() { ++dropped_, stops_.erase(stops_.begin()); }
  void drop_all();
  std::size_t count_kept() const { return kept_; }
  std::size_t count_dropped() const { return dropped_; }

 private:
  std::size_t self_;
  std::vector<std::vector<Visit>> planned_;  ///< of each robot
  std::vector<Stop> stops_;                  ///< those ahead
  bool as_planned_ = false;
  std::size_t kept_ = 0;
  std::size_t dropped_ = 0;
};

}  // namespace fleetmap::planning
