#pragma once

#include <vector>

#include "fleetmap/agent/trajectory_file.hpp"
#include "fleetmap/sim/robot_twin.hpp"

namespace fleetmap::apps {

/// Where a robot of the twin really was, base_link in ENU, every 0.02 s.
class TruthTrack {
 public:
  /// After every step of the twin.
  void follow(const sim::RobotTwin& twin);
  const std::vector<agent::StampedPose>& poses() const { return poses_; }

 private:
  std::vector<agent::StampedPose> poses_;
};

/// What is left of the battery, [0, 1].
double battery_share(const sim::RobotTwin& twin);

}  // namespace fleetmap::apps
