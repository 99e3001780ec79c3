#pragma once

#include <Eigen/Core>
#include <memory>

#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/sim/vehicle_spec.hpp"
#include "fleetmap/sim/world.hpp"

namespace fleetmap::sim {

/// The chassis on the ground of a world: follows commands as far as inertia, obstacles and battery let it.
class Vehicle {
 public:
  /// `p` must be free.
  Vehicle(const VehicleSpec& spec, std::shared_ptr<const World> world, const Eigen::Vector2d& p, double yaw);

  /// Advances by `dt` s (at most some 10 ms) under the commanded speed (m/s) and yaw rate (rad/s).
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
  void update_suspension(double dt);
  Eigen::Vector3d ground() const;

  VehicleSpec spec_;
  std::shared_ptr<const World> world_;
  Eigen::Vector2d p_;
  double yaw_ = 0.0, speed_ = 0.0, yaw_rate_ = 0.0, commanded_speed_ = 0.0, commanded_yaw_rate_ = 0.0;
  double odometer_ = 0.0, battery_wh_ = 0.0;
  bool touching_ = false;
  Spring height_, slope_east_, slope_north_;  ///< of the body
  Pose T_enu_base_ = Pose::Identity();
};

}  // namespace fleetmap::sim
