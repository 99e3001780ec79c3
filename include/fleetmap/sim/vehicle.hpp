#pragma once

#include <Eigen/Core>
#include <memory>

#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/sim/world.hpp"

namespace fleetmap::sim {

/// A skid-steer chassis; the defaults are those of a Clearpath Jackal.
struct VehicleSpec {
  double max_speed = 2.0;         ///< m/s, forward and back
  double acceleration = 1.0;      ///< m/s^2
  double max_yaw_rate = 1.5;      ///< rad/s
  double yaw_acceleration = 3.0;  ///< rad/s^2
  double lag = 0.08;              ///< s, of the motors behind the command
  double radius = 0.35;           ///< m, of the round footprint that must stay free
  double base_height = 0.1;       ///< m, base_link above the ground
  double wheelbase = 0.36;        ///< m, distance of the contacts with the ground, both ways
  double suspension_rate = 2.5;   ///< Hz, natural frequency of the body on its tyres
  double suspension_damping = 0.7;
  double braking = 8.0;             ///< m/s^2, in front of an obstacle
  double command_timeout = 0.5;     ///< s, a command is forgotten after this; 0: never
  double battery_wh = 270.0;        ///< Wh, at start
  double idle_power_w = 45.0;       ///< W, computer and sensors
  double energy_per_metre = 60.0;   ///< J/m driven
  double energy_per_radian = 25.0;  ///< J/rad turned
  Status validate() const;
};

/// The chassis on the ground of a world: follows commands as far as inertia, obstacles and battery let it.
class Vehicle {
 public:
  /// `p` must be free.
  Vehicle(const VehicleSpec& spec, std::shared_ptr<const World> world, const Eigen::Vector2d& p, double yaw);

  /// Moves on by `dt` s (at most some 10 ms) under the wanted speed (m/s) and yaw rate (rad/s).
  void step(double forward_speed, double yaw_rate, double dt);

  const Pose& T_enu_base() const { return T_enu_base_; }
  double speed() const { return speed_; }        ///< m/s forward
  double yaw_rate() const { return yaw_rate_; }  ///< rad/s
  double odometer() const { return odometer_; }  ///< m driven, either way
  double battery_wh() const { return battery_wh_; }
  bool touching() const { return touching_; }

 private:
  /// A value that follows a target like a mass on a damped spring.
  struct Spring {
    double value = 0.0, rate = 0.0, target = 0.0;
    void follow(double next_target, double stiffness, double damping, double dt);
  };
  Eigen::Vector2d ahead(double distance) const;
  void drive(double forward_speed, double yaw_rate, double dt);
  void move(double wanted, double dt);
  void settle(double dt);
  Eigen::Vector3d ground() const;

  VehicleSpec spec_;
  std::shared_ptr<const World> world_;
  Eigen::Vector2d p_;
  double yaw_ = 0.0, speed_ = 0.0, yaw_rate_ = 0.0, wanted_speed_ = 0.0, wanted_yaw_rate_ = 0.0;
  double odometer_ = 0.0, battery_wh_ = 0.0;
  bool touching_ = false;
  Spring height_, slope_east_, slope_north_;  ///< of the body
  Pose T_enu_base_ = Pose::Identity();
};

}  // namespace fleetmap::sim
