#pragma once

#include "fleetmap/core/result.hpp"

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

}  // namespace fleetmap::sim
