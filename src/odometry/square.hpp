#pragma once

namespace fleetmap::odometry {

constexpr double square(double value) { return value * value; }

}  // namespace fleetmap::odometry
