#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "fleetmap/messages/messages.hpp"
#include "fleetmap/planning/mission/fleet_plan.hpp"

namespace fleetmap::planning {

using messages::MissionReport;
using messages::MissionState;
using messages::RowSet;

/// State of the whole mission as one robot has it, from its own work and the others' reports. Rows and robots
/// are indices in the plan.
class MissionBoard {
 public:
  MissionBoard(std::shared_ptr<const FleetPlan> plan, std::size_t self);

  void begin(Stamp now) { begun_ = now; }
  void hear(const MissionReport& report, Stamp now);
  void set_own(const MissionReport& report) { own_ = report; }
  void set_done(std::size_t row);
  /// Rows along which the fleet's nodes lie.
  void set_surveyed(const RowSet& rows, Stamp now);

  std::size_t rows() const { return plan_->mission.rows.size(); }
  std::size_t robots() const { return plan_->fleet.size(); }
  /// A row counts as driven if this robot drove it, if the robot that the plan gives it to says so in its
  /// last report and is not lost, or if any report said so and nodes lie along it. So a forged report counts
  /// until the next one of that robot or until the robot is lost, and the reports of other robots do not
  /// repeat it for longer.
  const RowSet& done() const { return done_; }
  /// Rows that count as driven, but along which no nodes lie, and the robot that says that it drove them.
  /// None as long as no row at all has nodes along it, as without GPS.
  std::vector<std::pair<std::size_t, std::size_t>> unconfirmed() const;
  /// Heard of lately (or not yet missed), and able to take rows.
  bool available(std::size_t robot, Stamp now) const;
  bool lost(std::size_t robot, Stamp now) const;
  /// Available, but has no rows.
  bool idle(std::size_t robot, Stamp now) const;
  bool claims(std::size_t robot, std::size_t row) const;
  bool under_way(std::size_t robot, std::size_t row) const;
  bool failed(std::size_t robot, std::size_t row) const;
  Eigen::Vector2d position(std::size_t robot) const;
  MissionState state(std::size_t robot, Stamp now) const;
  /// The last report of another robot, or the own one; null before the first.
  const MissionReport* report_of(std::size_t robot) const;

  void set_row_orders(const std::vector<messages::RowOrder>& orders);
  /// The robot to which an operator gave the row, if he named one.
  std::optional<std::size_t> receiver(std::size_t row) const;
  /// An operator took the row from the robot and named no other, and another one can drive it.
  bool barred(std::size_t robot, std::size_t row, Stamp now) const;

  /// Another available robot's claim goes before ours.
  bool lost_claim(std::size_t row, bool ours_under_way, Stamp now) const;
  /// Two of those who are left gave it up, or the only one who is.
  bool abandoned(std::size_t row, Stamp now) const;
  /// No robot, this one included, can drive rows.
  bool nobody_left(Stamp now) const;
  /// Done or abandoned.
  bool finished(std::size_t row, Stamp now) const { return done_.has(row) || abandoned(row, now); }
  bool all_finished(Stamp now) const;
  /// Not finished, and claimed by no robot that is available, this one included.
  std::vector<std::size_t> orphans(Stamp now) const;
  /// s that a robot still needs for what it claims, roughly.
  double remaining(std::size_t robot) const;

  /// Which robot takes each of the orphans, so that the fleet is done early.
  std::vector<std::size_t> takers(const std::vector<std::size_t>& orphans, Stamp now) const;
  /// The rows of `mine` that we had better give to idle robots; empty if that gains less than `gain` (s).
  std::vector<std::size_t> to_give_away(const std::vector<std::size_t>& mine, double busy, const Pose2& pose,
                                        double gain, Stamp now) const;

 private:
  struct Peer {
    std::optional<MissionReport> last;
    Stamp heard;
  };
  void resolve_done(Stamp now);
  bool can_drive(std::size_t robot, std::size_t row, Stamp now) const {
    return available(robot, now) && !failed(robot, row);
  }

  struct Handover {
    std::size_t by = 0;
    std::optional<std::size_t> to;
  };
  std::shared_ptr<const FleetPlan> plan_;
  std::size_t self_;
  std::vector<RowSet> planned_;  ///< of each robot, from the start
  std::vector<Peer> peers_;
  MissionReport own_;
  RowSet driven_;    ///< by this robot
  RowSet reported_;  ///< by anyone, ever
  RowSet surveyed_;
  RowSet done_;
  std::map<std::size_t, Handover> handovers_;  ///< by row
  Stamp begun_;
};

}  // namespace fleetmap::planning
