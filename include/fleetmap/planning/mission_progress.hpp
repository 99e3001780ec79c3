#pragma once

#include <cstdint>
#include <vector>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/planning/mission.hpp"

namespace fleetmap::planning {

enum class MissionState : std::uint8_t { kDriving, kMeeting, kDone, kStuck, kLowBattery, kLost };
const char* to_string(MissionState state);

/// What a robot tells the others of its part of the mission, every few seconds over the long range. Together
/// with what was heard before, everything a robot needs to take over another's rows.
struct MissionReport {
  AgentId agent;
  Stamp stamp;  ///< of the sender's clock
  MissionState state = MissionState::kDriving;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< ENU, m
  double battery = 1.0;                                ///< share left, [0, 1]
  std::vector<RowId> done;                             ///< driven to their end by this robot
  std::vector<RowId> claimed;  ///< planned by this robot, in order; the first is under way
};

}  // namespace fleetmap::planning
