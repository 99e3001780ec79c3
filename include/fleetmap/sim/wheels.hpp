#pragma once

#include <cstdint>
#include <memory>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/sensor/samples.hpp"
#include "fleetmap/sim/wheel_spec.hpp"

namespace fleetmap::sim {

/// Wheel odometry of a skid-steer robot. Deterministic in `seed`.
class WheelModel {
 public:
  WheelModel(const WheelSpec& spec, std::uint64_t seed);
  ~WheelModel();
  WheelModel(WheelModel&&) noexcept;
  /// True forward speed (m/s) and yaw rate (rad/s) in base_link. Call at every period, in order.
  sensor::Wheel measure(Stamp stamp, double forward_speed, double yaw_rate);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fleetmap::sim
