#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "fleetmap/planning/mission/fleet_plan.hpp"
#include "mission/mission_board.hpp"

namespace fleetmap::planning {

/// The rows that one robot claims: those it still has to drive and the one under way. Begins with the plan's,
/// takes over rows that nobody claims and gives rows away to idle robots.
class RowClaims {
 public:
  RowClaims(std::shared_ptr<const FleetPlan> plan, std::size_t self);

  /// Claims what the plan gives to this robot.
  void begin();
  /// Drops rows that are done, claimed by another robot with precedence, or `abandoned`. True if the row
  /// under way is among them. A row under way is driven to its end even if others report it as done, because
  /// nodes lie along it before it is driven.
  bool drop_lost(const MissionBoard& board, const RowSet& abandoned, Stamp now);
  /// Claims rows that an operator gave to this robot.
  void take_ordered(const MissionBoard& board, const RowSet& abandoned, Stamp now);
  /// Claims orphans that fall to this robot by the common division, or that nobody took for too long.
  void take_orphans(const MissionBoard& board, const RowSet& abandoned, Stamp now);
  /// Gives rows to idle robots if the fleet is done earlier by it. The robot sets out from `then` after
  /// `busy` s.
  void give_away(const MissionBoard& board, double busy, const Pose2& then, Stamp now);
  /// Gives back everything.
  void release_all();

  void start(std::size_t row);
  void end_current() { current_.reset(); }
  void defer(std::size_t row) { queue_.push_back(row); }
  void drop(std::size_t row) { std::erase(queue_, row); }
  void sort();

  /// Without the row under way.
  const std::vector<std::size_t>& queue() const { return queue_; }
  const std::optional<std::size_t>& current() const { return current_; }
  /// The row under way last.
  std::vector<std::size_t> all() const;
  RowSet as_set() const;
  /// Rows taken over, given away or given back.
  std::uint64_t changes() const { return changes_; }

 private:
  std::shared_ptr<const FleetPlan> plan_;
  std::size_t self_;
  std::vector<std::size_t> queue_;
  std::optional<std::size_t> current_;
  std::vector<std::optional<Stamp>> orphan_since_;  ///< one a row
  Stamp next_takeover_{};
  Stamp next_offer_{};
  std::uint64_t changes_ = 0;
};

}  // namespace fleetmap::planning
