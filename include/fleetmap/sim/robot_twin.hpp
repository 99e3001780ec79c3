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
#include "fleetmap/sim/vehicle.hpp"
#include "fleetmap/sim/wheels.hpp"
#include "fleetmap/sim/world.hpp"

namespace fleetmap::sim {

/// One robot of the twin: chassis, sensors and their mounts.
struct RobotTwinConfig {
  LidarSpec lidar;
  Pose T_base_lidar = Pose::Identity();
  ImuSpec imu;
  Pose T_base_imu = Pose::Identity();
  GpsSpec gps;
  Eigen::Vector3d p_base_antenna = Eigen::Vector3d::Zero();  ///< m
  WheelSpec wheels;
  VehicleSpec vehicle;
  bool start_given = false;                         ///< else who sets the team up chooses start and start_yaw
  Eigen::Vector2d start = Eigen::Vector2d::Zero();  ///< ENU, m
  double start_yaw = 0.0;                           ///< rad, from east, counter-clockwise
  bool guided = false;  ///< who steers it is told where it truly is, as a person who walks beside it would be
  std::uint64_t seed = 1;  ///< of all this robot's randomness
  /// Fails with the section, the field and the rule that it breaks.
  Status validate() const;
};

/// A revolution whose rays are still to be cast: everything that cast_scan() needs, so that it can run on any
/// thread, at any time, with the same result.
struct ScanJob {
  Stamp stamp;                    ///< of the first firing
  Duration step{};                ///< between two of the poses
  std::vector<Pose> T_enu_lidar;  ///< from stamp to the last firing, at least two
  std::uint64_t number = 0;       ///< of this robot's scans, from 0
  std::uint64_t seed = 0;
};

/// What became due, in the order of time; a scan becomes due when its last ray was fired.
using TwinSample = std::variant<sensor::Imu, sensor::Fix, sensor::Wheel, ScanJob>;

/// Moment at which the sample became due: a scan's last ray, everything else's stamp.
Stamp due(const TwinSample& sample);

/// A robot that moves through a world and senses it. Deterministic: the same commands at the same times give
/// the same samples. Not thread-safe; cast_scan() is.
class RobotTwin {
 public:
  /// Fails when the start is outside the world or inside something: says where, what distance is free and
  /// what to change. Site ENU is that of `origin`.
  static Result<RobotTwin> create(std::shared_ptr<const World> world, const GeoPoint& origin,
                                  const RobotTwinConfig& config, Stamp start);

  /// Wanted speed (m/s) and yaw rate (rad/s) from now on; forgotten after VehicleSpec::command_timeout.
  void command(double forward_speed, double yaw_rate);
  /// Moves on to `stamp` in steps of 5 ms (the rest waits for the next call); returns what the sensors gave
  /// in between.
  std::vector<TwinSample> advance(Stamp stamp);

  /// The scan that becomes due next, with the poses that it has so far: those of its first firings can be
  /// cast, see firings_known().
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
