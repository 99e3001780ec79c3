#pragma once

#include <optional>

#include "fleetmap/odometry/loam.hpp"
#include "fleetmap/odometry/motion_covariance.hpp"
#include "fleetmap/ros_codec/samples.hpp"

namespace fleetmap::agent {

/// Makes nav_msgs/Odometry of the odometry's updates: the covariance of a pose is that of the whole way since
/// the start, in the axes of the odometry frame, also over a local map that began anew; that of the twist
/// follows from the motion since the scan before.
class OdometryMessages {
 public:
  /// Every update, in order. `counters` tell whether its local map began anew.
  ros_codec::OdometryMsg next(const odometry::OdometryUpdate& update, const odometry::LoamCounters& counters);

 private:
  std::uint64_t frame_ = 0;          ///< restarts of the odometry so far
  std::optional<Stamp> last_;        ///< the scan before, of the same local map
  odometry::MotionCovariance way_;   ///< since the start
  odometry::MotionCovariance step_;  ///< since the scan before
};

}  // namespace fleetmap::agent
