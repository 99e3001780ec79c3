#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "fleetmap/sim/robot_twin.hpp"

namespace fleetmap::testing {

/// The robot of the odometry's drives, with sensors mounted obliquely.
sim::RobotTwinConfig drive_robot(const sim::LidarSpec& lidar, std::uint64_t seed);
/// Drives of other seeds begin in other lanes.
double first_lane_of(std::uint64_t seed);

/// A drive of about `length` m at 1 m/s up and down the lanes of a world, beginning in the lane `first_lane`
/// (a share of all, 0 to 1): with a stop of 3 s after a quarter, and a full turn on the spot after three
/// quarters. Deterministic.
class TwinDrive {
 public:
  TwinDrive(std::shared_ptr<const sim::World> world, std::shared_ptr<const sim::Scene> scene,
            const sim::RobotTwinConfig& robot, double first_lane, double length);

  struct Listener {
    std::function<void(const sensor::Imu&)> imu;
    std::function<void(const sensor::Wheel&)> wheel;
    /// With the true pose of base_link at the scan's stamp.
    std::function<void(const sensor::Scan&, const Pose& T_enu_base)> scan;
  };
  /// Drives it; samples come in the order in which they became due. False if the robot got stuck.
  bool run(const Listener& listener);

 private:
  void command(sim::RobotTwin& twin, double seconds);

  std::shared_ptr<const sim::World> world_;
  std::shared_ptr<const sim::Scene> scene_;
  sim::RobotTwinConfig robot_;
  double length_;
  std::vector<Eigen::Vector2d> path_;
  std::size_t next_ = 1;
  double standing_ = 0.0, turned_ = 0.0;  ///< s and rad of the stop and of the turn that are done
};

}  // namespace fleetmap::testing
