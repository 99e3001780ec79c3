#include "fleetmap/sim/wheels.hpp"

#include "gaussian.hpp"
#include "spec_rules.hpp"

namespace fleetmap::sim {

struct WheelModel::State {
  State(const WheelSpec& s, std::uint64_t seed)
      : spec(s), random(seed, 0x3ee1), slip(1.0, s.slip_time), yaw_slip(1.0, s.slip_time) {
    scale = 1.0 + spec.scale_sigma * random.normal();
    yaw_scale = 1.0 + spec.yaw_scale_sigma * random.normal();
  }
  WheelSpec spec;
  RandomStream random;
  GaussMarkov slip, yaw_slip;
  double scale, yaw_scale;
};

WheelModel::WheelModel(const WheelSpec& spec, std::uint64_t seed)
    : state_(std::make_unique<State>(spec, seed)) {}
WheelModel::~WheelModel() = default;
WheelModel::WheelModel(WheelModel&&) noexcept = default;

sensor::Wheel WheelModel::measure(Stamp stamp, double forward_speed, double yaw_rate) {
  State& s = *state_;
  const double sigma = s.spec.slip + s.spec.slip_turning * std::abs(yaw_rate);
  const double slip = sigma * s.slip.next(1.0 / s.spec.rate, s.random);
  const double yaw_slip = sigma * s.yaw_slip.next(1.0 / s.spec.rate, s.random);
  sensor::Wheel wheel;
  wheel.stamp = stamp;
  wheel.forward_speed = forward_speed * s.scale * (1.0 + slip) + s.spec.speed_noise * s.random.normal();
  const double turned = yaw_rate * s.yaw_scale * (1.0 + yaw_slip) + s.spec.yaw_rate_noise * s.random.normal();
  if (s.spec.reports_yaw_rate) wheel.yaw_rate = turned;
  return wheel;
}

}  // namespace fleetmap::sim
