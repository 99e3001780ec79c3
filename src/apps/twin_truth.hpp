#pragma once

#include <vector>

#include "fleetmap/geometry/global_pose.hpp"
#include "fleetmap/output/trajectory_file.hpp"
#include "fleetmap/sim/robot_twin.hpp"

namespace fleetmap::apps {

/// Where a robot of the twin really was, base_link in ENU, every 0.02 s.
class TruthTrack {
 public:
  /// After every step of the twin.
  void follow(const sim::RobotTwin& twin);
  const output::Trajectory& poses() const { return poses_; }

 private:
  output::Trajectory poses_;
};

/// How often who leads a robot is told where it is.
constexpr Duration kGuidePeriod = std::chrono::milliseconds(100);

/// Where the robot of the twin truly is; `site`: the twin's ENU. Of no covariance.
GlobalPose true_pose(const sim::RobotTwin& twin, const LocalFrame& site);

/// What is left of the battery, [0, 1].
double battery_share(const sim::RobotTwin& twin);

}  // namespace fleetmap::apps
