#pragma once

#include <vector>

#include "fleetmap/geometry/global_pose.hpp"
#include "fleetmap/output/trajectory_file.hpp"
#include "fleetmap/sim/robot_twin.hpp"

namespace fleetmap::apps {

/// True trajectory of a robot of the twin, base_link in ENU, every 0.02 s.
class TruthTrack {
 public:
  /// After every step of the twin.
  void follow(const sim::RobotTwin& twin);
  const output::Trajectory& poses() const { return poses_; }

 private:
  output::Trajectory poses_;
};

/// Period of a guide's poses.
constexpr Duration kGuidePeriod = std::chrono::milliseconds(100);

/// True pose of the robot, without covariance; `site`: the twin's ENU.
GlobalPose true_pose(const sim::RobotTwin& twin, const LocalFrame& site);

/// State of charge of the battery, [0, 1].
double battery_share(const sim::RobotTwin& twin);

}  // namespace fleetmap::apps
