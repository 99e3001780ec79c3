#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/sensor/samples.hpp"
#include "fleetmap/sensor/scan.hpp"
#include "fleetmap/sim/gps.hpp"
#include "fleetmap/sim/imu.hpp"
#include "fleetmap/sim/lidar.hpp"
#include "fleetmap/sim/robot_twin_config.hpp"
#include "fleetmap/sim/vehicle.hpp"
#include "fleetmap/sim/wheels.hpp"
#include "fleetmap/sim/world.hpp"

namespace fleetmap::sim {

/// A revolution whose rays are still to be cast: everything that cast_scan() needs, so that it can run on any
/// thread, at any time, with the same result.
struct ScanJob {
  Stamp stamp;                    ///< of the first firing
  Duration step{};                ///< between two of the poses
  std::vector<Pose> T_enu_lidar;  ///< from stamp to the last firing, at least two
  std::uint64_t number = 0;       ///< of this robot's scans, from 0
  std::uint64_t seed = 0;
};

/// Samples that became due, in the order of time; a scan becomes due when its last ray was fired.
using TwinSample = std::variant<sensor::Imu, sensor::Fix, sensor::Wheel, ScanJob>;

/// Moment at which the sample became due: a scan's last ray, everything else's stamp.
Stamp due(const TwinSample& sample);

/// A robot that moves through a world and senses it. Deterministic: the same commands at the same times yield
/// the same samples. Not thread-safe; cast_scan() is.
class RobotTwin {
 public:
  /// Fails when the start is outside the world or inside an obstacle, and names the place, the free distance
  /// and the remedy. Site ENU is that of `origin`.
  static Result<RobotTwin> create(std::shared_ptr<const World> world, const GeoPoint& origin,
                                  const RobotTwinConfig& config, Stamp start);

  /// Sets the speed (m/s) and yaw rate (rad/s) of the command, which expires after
  /// VehicleSpec::command_timeout.
  void command(double forward_speed, double yaw_rate);
  /// Advances to `stamp` in steps of 5 ms (the rest waits for the next call); returns the samples since the
  /// last call.
  std::vector<TwinSample> advance(Stamp stamp);

  /// The scan that becomes due next, with the poses that it has so far: those of its first firings can be
  /// cast, see firings_ready().
  ScanJob scan_under_way() const;

  Stamp now() const;
  Pose T_enu_base() const;  ///< the truth
  double speed() const;     ///< m/s forward, the truth
  double odometer() const;  ///< m driven
  double battery_wh() const;
  bool touching() const;  ///< something is in the way: it cannot move on in this direction
  const RobotTwinConfig& config() const { return config_; }

 private:
  struct State;
  RobotTwin(const RobotTwinConfig& config, std::shared_ptr<State> state)
      : config_(config), state_(std::move(state)) {}
  RobotTwinConfig config_;
  std::shared_ptr<State> state_;
};

}  // namespace fleetmap::sim
