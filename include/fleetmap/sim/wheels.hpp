#pragma once

#include <cstdint>
#include <memory>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/sensor/samples.hpp"

namespace fleetmap::sim {

struct WheelSpec {
  double rate = 20.0;             ///< Hz
  double scale_sigma = 0.01;      ///< of the speed, constant for a robot: tyres
  double yaw_scale_sigma = 0.05;  ///< of the yaw rate, constant for a robot: the skid-steer's track
  double slip = 0.02;             ///< of the speed, 1 sigma going straight; comes and goes
  double slip_turning = 0.10;     ///< added to `slip` for each rad/s of yaw rate: a skid-steer scrubs
  double slip_time = 0.5;         ///< s, how long a slip lasts
  double speed_noise = 0.01;      ///< m/s, white
  double yaw_rate_noise = 0.02;   ///< rad/s, white
  bool reports_yaw_rate = true;
  Status validate() const;
};

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
