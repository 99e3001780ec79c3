#include "sample_check.hpp"

#include <algorithm>
#include <iterator>

#include "fleetmap/sensor/ground_plane.hpp"

namespace fleetmap::apps {
namespace {

struct Check {
  sensor::SensorHealth& health;
  const Pose& T_base_lidar;
  bool operator()(sensor::Scan& scan) const {
    health.check_scan(scan.stamp, sensor::sweep_of(scan));
    if (health.ground_due()) {
      if (const auto normal = sensor::ground_normal(scan, T_base_lidar)) health.check_ground(*normal);
    }
    return true;
  }
  bool operator()(sensor::Imu& imu) const { return health.check(imu); }
  bool operator()(sensor::Fix& fix) const { return health.check(fix); }
  bool operator()(sensor::Wheel& wheel) const { return health.check(wheel); }
};

}  // namespace

SampleCheck::SampleCheck(const recording::LogClock& log_clock, const agent::PerceptionConfig& config)
    : times_(log_clock), uses_gps_(config.uses_gps) {
  set_mounts(config);
  if (config.gyro_in_degrees) health_.expect_degrees(*config.gyro_in_degrees);
}

void SampleCheck::set_mounts(const agent::PerceptionConfig& config) {
  T_base_lidar_ = config.odometry.T_base_lidar;
  health_.set_imu_rotation(config.odometry.q_base_imu);
}

void SampleCheck::add_motion(const odometry::OdometryUpdate& update) {
  health_.check_motion(update.stamp, update.lost ? std::nullopt : std::optional(update.T_odom_base));
}

bool SampleCheck::admit(recording::Sample& sample, std::optional<Stamp> recorded) {
  const auto source = static_cast<sensor::Source>(sample.index());  // the order of both is the same
  if (source == sensor::Source::kGps && !uses_gps_) return false;
  now_ = std::max(now_, times_.of(sample, recorded));
  clocks_.add(source, recording::stamp_of(sample), now_);
  std::visit([&](auto& s) { s.stamp += clocks_.correction(source); }, sample);
  if (!clocks_.unclear(source)) return std::visit(Check{health_, T_base_lidar_}, sample);
  std::visit([&](const auto& held) { health_.hold(held); }, sample);
  return false;
}

std::vector<std::string> SampleCheck::take_warnings() {
  std::vector<std::string> news = clocks_.take_warnings();
  std::ranges::move(health_.take_warnings(), std::back_inserter(news));
  return news;
}

}  // namespace fleetmap::apps
