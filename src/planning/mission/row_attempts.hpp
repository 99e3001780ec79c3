#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fleetmap/messages/mission_report.hpp"

namespace fleetmap::planning {

using messages::RowSet;

/// The attempts of one robot at rows that turned out to be blocked: how far it came from each end, and which
/// rows it gave up. Other robots may still try those; enough of them abandon the row (MissionBoard).
class RowAttempts {
 public:
  explicit RowAttempts(std::size_t rows);

  enum class Outcome : std::uint8_t {
    kDriven,     ///< all but a rest that was seen from both ends
    kRetry,      ///< later, from the other end
    kAbandoned,  ///< as often as a robot may try
  };
  /// The direction of the next attempt: from the end that was not tried last, else `planned`.
  bool next_reversed(std::size_t row, bool planned) const;
  void begin(std::size_t row, bool reversed) { last_reversed_[row] = reversed; }
  /// The attempt ended `driven` m into a row of `length` m because the robot at `position` is stuck.
  Outcome blocked(std::size_t row, double driven, double length, const Eigen::Vector2d& position,
                  int max_attempts);
  /// There was no way to the row. True if it is given up with this.
  bool unreachable(std::size_t row, const std::string& reason);
  /// The robot can move again: rows that were given up may be tried anew.
  void reset();

  bool tried(std::size_t row) const { return attempts_[row] > 0; }
  const RowSet& abandoned() const { return abandoned_; }
  /// Why this robot gave the row up; empty if it did not.
  const std::string& reason(std::size_t row) const { return reasons_[row]; }
  /// Counts each time that any row was given up.
  std::uint64_t times_abandoned() const { return times_abandoned_; }

 private:
  void give_up(std::size_t row, std::string reason);

  RowSet abandoned_;
  std::uint64_t times_abandoned_ = 0;
  std::vector<int> attempts_;
  std::vector<bool> last_reversed_;
  std::vector<std::array<double, 2>> covered_;  ///< m of each row driven from its first and its last waypoint
  std::vector<int> failed_routes_;
  std::vector<std::string> reasons_;
};

}  // namespace fleetmap::planning
