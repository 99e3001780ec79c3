#include "fleetmap/sim/robot_twin.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <numbers>

#include "counter_random.hpp"
#include "spec_rules.hpp"

namespace fleetmap::sim {
namespace {

constexpr Duration kStep = std::chrono::milliseconds(5);
constexpr double kStepSeconds = 5e-3;

/// Evenly spaced moments from `start` on, without drift.
class Clock {
 public:
  Clock(Stamp start, double rate) : start_(start), period_(1e9 / rate) {}
  Stamp at(std::uint64_t k) const {
    return start_ + Duration(std::llround(period_ * static_cast<double>(k)));
  }
  Stamp last() const { return at(count_); }
  Stamp next() const { return at(count_ + 1); }
  std::uint64_t count() const { return count_; }
  /// The number of the period that ends at next().
  std::uint64_t pass() { return count_++; }

 private:
  Stamp start_;
  double period_;  ///< ns
  std::uint64_t count_ = 0;
};

struct Truth {
  Stamp stamp;
  Pose T_enu_base = Pose::Identity();
  double speed = 0.0, yaw_rate = 0.0;
};

std::string at_text(const Eigen::Vector2d& p) {
  char text[64];
  std::snprintf(text, sizeof text, "[%.2f, %.2f]", p.x(), p.y());
  return text;
}

/// The free place nearest to `p`, on rings about it.
std::optional<Eigen::Vector2d> nearest_free(const World& world, const Eigen::Vector2d& p, double radius) {
  for (int quarter = 1; quarter <= 200; ++quarter) {
    const double ring = 0.25 * quarter;  // m
    const int steps = std::max(16, static_cast<int>(ring * 16.0));
    for (int k = 0; k < steps; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / steps;
      const Eigen::Vector2d q = p + ring * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      if (!world.blocked(q, radius)) return q;
    }
  }
  return std::nullopt;
}

Status check_start(const World& world, const RobotTwinConfig& config) {
  const Eigen::Vector2d p = config.start;
  const double radius = config.vehicle.radius;
  if (!world.blocked(p, radius)) return {};
  char text[160];
  std::string what = "start: " + at_text(p);
  if (!world.bounds().contains(p)) {
    what += " is outside the world, which reaches from " + at_text(world.bounds().low) + " to " +
            at_text(world.bounds().high);
  } else {
    const double free = std::max(0.0, world.clearance(p, 10.0 * radius));
    std::snprintf(text, sizeof text, " is inside something or too near to it: %.2f m are free, %.2f m needed",
                  free, radius);
    what += text;
  }
  if (const auto free = nearest_free(world, p, radius)) {
    std::snprintf(text, sizeof text, "; set start to %s, %.2f m away", at_text(*free).c_str(),
                  (*free - p).norm());
    what += text;
  } else {
    what += "; set start to a free place, there is none within 50 m";
  }
  return failure(what);
}

}  // namespace

Stamp due(const TwinSample& sample) {
  if (const auto* job = std::get_if<ScanJob>(&sample)) {
    return job->stamp + static_cast<std::int64_t>(job->T_enu_lidar.size() - 1) * job->step;
  }
  if (const auto* imu = std::get_if<sensor::Imu>(&sample)) return imu->stamp;
  if (const auto* fix = std::get_if<sensor::Fix>(&sample)) return fix->stamp;
  return std::get<sensor::Wheel>(sample).stamp;
}

struct RobotTwin::State {
  State(std::shared_ptr<const World> world, const LocalFrame& site, const RobotTwinConfig& c, Stamp s)
      : config(c),
        start(s),
        vehicle(c.vehicle, std::move(world), c.start, c.start_yaw),
        imu(c.imu, mixed(c.seed)),
        gps(c.gps, site, mixed(c.seed)),
        wheels(c.wheels, mixed(c.seed)),
        imu_clock(s, c.imu.rate),
        gps_clock(s, c.gps.rate),
        wheel_clock(s, c.wheels.rate),
        scan_clock(s, c.lidar.rate),
        now(s) {
    history.push_back({now, vehicle.T_enu_base(), 0.0, 0.0});
    imu_before = imu_motion(now);
  }

  void step(std::vector<TwinSample>& samples);
  Truth truth(Stamp stamp) const;
  ImuMotion imu_motion(Stamp stamp) const;
  /// With the poses up to now.
  ScanJob scan_job(std::uint64_t number) const;

  RobotTwinConfig config;
  Stamp start;
  Vehicle vehicle;
  ImuModel imu;
  GpsModel gps;
  WheelModel wheels;
  Clock imu_clock, gps_clock, wheel_clock, scan_clock;
  Stamp now;
  double wanted_speed = 0.0, wanted_yaw_rate = 0.0;
  std::optional<Stamp> commanded;
  std::deque<Truth> history;  ///< every step since the first firing of the scan under way
  ImuMotion imu_before;
};

/// At any moment of the history.
Truth RobotTwin::State::truth(Stamp stamp) const {
  const auto steps = (stamp - history.front().stamp) / kStep;
  const auto k = static_cast<std::size_t>(std::max<std::int64_t>(0, steps));
  if (k + 1 >= history.size()) return history.back();
  const Truth &a = history[k], &b = history[k + 1];
  const double alpha = to_seconds(stamp - a.stamp) / kStepSeconds;
  if (alpha <= 0.0) return a;
  return {stamp, interpolate(a.T_enu_base, b.T_enu_base, alpha), a.speed + alpha * (b.speed - a.speed),
          a.yaw_rate + alpha * (b.yaw_rate - a.yaw_rate)};
}

/// Velocities are those of the steps (at their middles), blended: the sum of the accelerations is the motion.
ImuMotion RobotTwin::State::imu_motion(Stamp stamp) const {
  ImuMotion motion{stamp, truth(stamp).T_enu_base * config.T_base_imu, Eigen::Vector3d::Zero()};
  const auto velocity = [&](Stamp at) -> Eigen::Vector3d {
    const Stamp from = std::max(at - kStep, history.front().stamp);
    if (at <= from) return Eigen::Vector3d::Zero();
    const Pose& T_base_imu = config.T_base_imu;
    return ((truth(at).T_enu_base * T_base_imu).translation() -
            (truth(from).T_enu_base * T_base_imu).translation()) /
           to_seconds(at - from);
  };
  motion.velocity_enu = velocity(stamp);
  return motion;
}

ScanJob RobotTwin::State::scan_job(std::uint64_t number) const {
  ScanJob job;
  job.stamp = scan_clock.at(number);
  job.number = number;
  job.seed = mixed(config.seed ^ 0x11da);
  const Duration period = scan_clock.at(number + 1) - job.stamp;
  const std::int64_t parts = std::max<std::int64_t>(1, (period + kStep / 2) / kStep);
  job.step = period / parts;
  for (std::int64_t k = 0; k <= parts && job.stamp + k * job.step <= now; ++k) {
    job.T_enu_lidar.push_back(truth(job.stamp + k * job.step).T_enu_base * config.T_base_lidar);
  }
  return job;
}

void RobotTwin::State::step(std::vector<TwinSample>& samples) {
  const double timeout = config.vehicle.command_timeout;
  if (commanded && timeout > 0.0 && now - *commanded >= from_seconds(timeout)) {
    wanted_speed = wanted_yaw_rate = 0.0;
    commanded.reset();
  }
  vehicle.step(wanted_speed, wanted_yaw_rate, kStepSeconds);
  now += kStep;
  history.push_back({now, vehicle.T_enu_base(), vehicle.speed(), vehicle.yaw_rate()});

  const auto first = static_cast<std::ptrdiff_t>(samples.size());
  for (; imu_clock.next() <= now; imu_clock.pass()) {
    const ImuMotion motion = imu_motion(imu_clock.next());
    samples.emplace_back(imu.measure(imu_before, motion));
    imu_before = motion;
  }
  for (; wheel_clock.next() <= now; wheel_clock.pass()) {
    const Truth t = truth(wheel_clock.next());
    samples.emplace_back(wheels.measure(t.stamp, t.speed, t.yaw_rate));
  }
  for (; gps_clock.next() <= now; gps_clock.pass()) {
    const Stamp at = gps_clock.next();
    const auto fix = gps.measure(at, to_seconds(at - start), truth(at).T_enu_base * config.p_base_antenna);
    if (fix) samples.emplace_back(*fix);
  }
  while (scan_clock.next() <= now) samples.emplace_back(scan_job(scan_clock.pass()));
  std::stable_sort(samples.begin() + first, samples.end(),
                   [](const TwinSample& a, const TwinSample& b) { return due(a) < due(b); });
  const Stamp needed = std::min(scan_clock.last(), now - 2 * kStep);
  while (history.size() > 2 && history[1].stamp <= needed) history.pop_front();
}

Result<RobotTwin> RobotTwin::create(std::shared_ptr<const World> world, const GeoPoint& origin,
                                    const RobotTwinConfig& config, Stamp start) {
  if (!world) return failure("a robot needs a world");
  if (!is_valid(origin)) return failure("origin: must be a position on the Earth");
  if (const Status sound = config.validate(); !sound) return tl::unexpected(sound.error());
  if (const Status free = check_start(*world, config); !free) return tl::unexpected(free.error());
  return RobotTwin(config, std::make_shared<State>(std::move(world), LocalFrame(origin), config, start));
}

void RobotTwin::command(double forward_speed, double yaw_rate) {
  if (!std::isfinite(forward_speed) || !std::isfinite(yaw_rate)) return;
  state_->wanted_speed = forward_speed;
  state_->wanted_yaw_rate = yaw_rate;
  state_->commanded = state_->now;
}

std::vector<TwinSample> RobotTwin::advance(Stamp stamp) {
  std::vector<TwinSample> samples;
  while (state_->now + kStep <= stamp) state_->step(samples);
  return samples;
}

ScanJob RobotTwin::scan_under_way() const { return state_->scan_job(state_->scan_clock.count()); }

Stamp RobotTwin::now() const { return state_->now; }
Pose RobotTwin::T_enu_base() const { return state_->vehicle.T_enu_base(); }
double RobotTwin::speed() const { return state_->vehicle.speed(); }
double RobotTwin::odometer() const { return state_->vehicle.odometer(); }
double RobotTwin::battery_wh() const { return state_->vehicle.battery_wh(); }
bool RobotTwin::touching() const { return state_->vehicle.touching(); }

}  // namespace fleetmap::sim
