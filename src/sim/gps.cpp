#include "fleetmap/sim/gps.hpp"

#include <algorithm>
#include <numbers>

#include "gaussian.hpp"
#include "spec_rules.hpp"

namespace fleetmap::sim {

struct GpsModel::State {
  State(const GpsSpec& s, const LocalFrame& site, std::uint64_t seed)
      : spec(s),
        frame(site),
        random(seed, 0x6505),
        phase(2.0 * std::numbers::pi * RandomStream(seed, 0x6506).uniform()) {
    for (int axis = 0; axis < 3; ++axis) {
      drift.emplace_back(spec.drift_sigma * (axis == 2 ? spec.vertical_factor : 1.0), spec.correlation_time);
    }
  }
  /// Same number of random draws at every fix, so that one setting does not change the luck of another.
  Eigen::Vector3d error(double seconds) {
    Eigen::Vector3d sum;
    for (int axis = 0; axis < 3; ++axis) {
      const double white = spec.white_sigma * (axis == 2 ? spec.vertical_factor : 1.0) * random.normal();
      sum[axis] = white + drift[static_cast<std::size_t>(axis)].next(1.0 / spec.rate, random);
    }
    const bool begins = random.uniform() < spec.jumps_per_hour / 3600.0 / spec.rate;
    const double direction = 2.0 * std::numbers::pi * random.uniform();
    if (begins && seconds >= jump_until) {
      jump = spec.jump_size * Eigen::Vector3d(std::cos(direction), std::sin(direction), 0.0);
      jump_until = seconds + spec.jump_duration;
    }
    if (seconds < jump_until) sum += jump;
    sum.z() += spec.altitude_wave * std::sin(2.0 * std::numbers::pi * seconds / spec.altitude_period + phase);
    return sum;
  }
  bool out(double seconds) const {
    return std::ranges::any_of(spec.outages,
                               [&](const GpsOutage& o) { return seconds >= o.from && seconds < o.until; });
  }

  GpsSpec spec;
  LocalFrame frame;
  RandomStream random;
  double phase;  ///< rad, of the altitude's wave at the start
  std::vector<GaussMarkov> drift;
  Eigen::Vector3d jump = Eigen::Vector3d::Zero();
  double jump_until = -1.0;
};

GpsModel::GpsModel(const GpsSpec& spec, const LocalFrame& site, std::uint64_t seed)
    : state_(std::make_unique<State>(spec, site, seed)) {}
GpsModel::~GpsModel() = default;
GpsModel::GpsModel(GpsModel&&) noexcept = default;

std::optional<sensor::Fix> GpsModel::measure(Stamp stamp, double seconds, const Eigen::Vector3d& p_enu) {
  const Eigen::Vector3d error = state_->error(seconds);
  if (!state_->spec.fitted || state_->out(seconds)) return std::nullopt;
  const GpsSpec& spec = state_->spec;
  sensor::Fix fix;
  fix.stamp = stamp;
  fix.position = state_->frame.to_geo(p_enu + error);
  const double horizontal =
      spec.covariance_factor * (spec.white_sigma * spec.white_sigma + spec.drift_sigma * spec.drift_sigma);
  const double vertical = horizontal * spec.vertical_factor * spec.vertical_factor;
  fix.covariance = Eigen::Vector3d(horizontal, horizontal, vertical).asDiagonal();
  return fix;
}

}  // namespace fleetmap::sim
