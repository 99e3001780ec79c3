#pragma once

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "fleetmap/agent/perception_config.hpp"
#include "fleetmap/recording/reader.hpp"
#include "support/synthetic_lidar.hpp"

namespace fleetmap::apps {

/// The time at which a drive starts.
inline constexpr Stamp kStart = stamp_from_ns(1'700'000'000'000'000'000);

/// Perception with the mount of the robot's LiDAR.
inline agent::PerceptionConfig made_robot_perception() {
  agent::PerceptionConfig config;
  config.odometry.T_base_lidar = testing::ScanOptions{}.T_base_lidar;
  return config;
}

/// A sample and when its driver sends it.
struct SentSample {
  recording::Sample sample;
  Stamp sent;
};

/// Samples that a robot's drivers send while it swings through a yard from the left to the right: VLP-16 at
/// 10 Hz with 30 % of its returns, 0.8 m above base_link, IMU at 100 Hz and wheels at 20 Hz. With a speed of
/// 0 it stands.
inline std::vector<SentSample> samples_of_a_robot(double speed, double seconds, Stamp start) {
  const double yaw_rate = speed > 0.0 ? 0.8 : 0.0;
  std::vector<testing::DriveLeg> legs{{0.8, speed, yaw_rate}};
  for (double t = 0.8; t < seconds + 1.0; t += 1.6)
    legs.push_back({1.6, speed, legs.back().yaw_rate > 0.0 ? -yaw_rate : yaw_rate});
  const testing::SyntheticDrive drive(legs);
  const auto world = testing::yard_world();
  const odometry::LidarModel lidar = odometry::vlp16();
  testing::ScanOptions options;
  options.keep = 0.3;
  std::vector<SentSample> samples;
  const auto send = [&](auto sample, Stamp sent) {
    sample.stamp += start.time_since_epoch();
    samples.push_back({std::move(sample), sent});
  };
  for (int tick = 0; tick < static_cast<int>(100.0 * seconds); ++tick) {
    const double t = 0.01 * tick;
    const Stamp now = start + from_seconds(t);
    send(drive.imu(t), now);
    if (tick % 5 == 0) send(drive.wheel(t), now);
    if (tick % 10 != 0 || tick == 0) continue;
    options.seed = static_cast<std::uint64_t>(tick);
    send(testing::make_scan(
             world, [&](double at) { return drive.at(at); }, t - 0.1, lidar, options),
         now);
  }
  return samples;
}

}  // namespace fleetmap::apps
