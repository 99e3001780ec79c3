#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fleetmap/agent/perception_config.hpp"
#include "fleetmap/odometry/loam.hpp"
#include "fleetmap/recording/play_times.hpp"
#include "fleetmap/recording/reader.hpp"
#include "fleetmap/sensor/clock_offsets.hpp"
#include "fleetmap/sensor/sensor_health.hpp"

namespace fleetmap::apps {

/// Checks samples of a recording as perception checks live ones before it uses them.
class SampleCheck {
 public:
  SampleCheck(const recording::LogClock& log_clock, const agent::PerceptionConfig& config);

  /// Mounts that were decided since.
  void set_mounts(const agent::PerceptionConfig& config);
  /// Corrects the sample. False if it must not be used: its clock is undecided, its values are
  /// unsound, or it is a fix and the robot does not use GPS (gps.use).
  /// `recorded` as Reader::recorded() has it.
  bool admit(recording::Sample& sample, std::optional<Stamp> recorded);
  /// Compares the other sensors with the odometry's motion.
  void add_motion(const odometry::OdometryUpdate& update);
  /// Adds the finding of a check that runs elsewhere to the warnings, once.
  void add_finding(std::string finding) { health_.add_finding(std::move(finding)); }
  /// Findings about clocks and values since the last call.
  std::vector<std::string> take_warnings();
  const sensor::SensorHealth& health() const { return health_; }

 private:
  recording::PlayTimes times_;
  bool uses_gps_;
  Pose T_base_lidar_;
  sensor::ClockOffsets clocks_;
  sensor::SensorHealth health_;
  Stamp now_{};
};

}  // namespace fleetmap::apps
