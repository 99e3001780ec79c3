#pragma once

#include <Eigen/Core>

#include "driving/local_field.hpp"
#include "driving/path_progress.hpp"
#include "fleetmap/planning/site/mission.hpp"

namespace fleetmap::planning {

/// The error of the position across the lane. Between two borders the path means the middle of the lane, so
/// the distance from the path to that middle is an error of the position. It is kept for a while after the
/// lane: the robot needs it to find the entrance of the next one.
class LaneOffset {
 public:
  /// `limit`: m, largest error that is believed.
  explicit LaneOffset(double limit) : limit_(limit) {}

  /// `pose`: corrected by the offset; `field`: the scan around it; `dt`: s since the last update.
  void update(const PathProgress& path, const LocalField& field, const Pose2& pose, double dt);
  /// m, ENU: to be subtracted from the position.
  const Eigen::Vector2d& offset() const { return offset_; }

 private:
  double limit_;
  Eigen::Vector2d offset_ = Eigen::Vector2d::Zero();
};

}  // namespace fleetmap::planning
