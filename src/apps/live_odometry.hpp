#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/agent/perception_config.hpp"
#include "fleetmap/bus/bus.hpp"
#include "fleetmap/recording/reader.hpp"
#include "sample_check.hpp"
#include "scan_odometry.hpp"
#include "sweep_inputs.hpp"

namespace fleetmap::apps {

/// Runs the odometry over the scans of a live robot, one at a time and off the callback thread, so that gyro,
/// wheels and GPS are compared with its motion. Scans that come faster than this computer works on them are
/// left out and counted.
class LiveOdometry {
 public:
  /// `bus` and `check` outlive this; `check` gets the motions and findings.
  LiveOdometry(const agent::PerceptionConfig& config, bus::Bus& bus, SampleCheck& check)
      : config_(config), bus_(bus), check_(check) {}

  /// Mounts that were decided since; that of the LiDAR before its first scan is added.
  void set_mounts(const agent::PerceptionConfig& config) { config_ = config; }
  /// A sample that may be used.
  void add(recording::Sample sample);
  /// No scan is under way.
  bool idle() const { return !busy_; }
  /// While idle: sentences on what the odometry could not do.
  std::vector<std::string> failures() const;
  /// Sentences on what was not compared, and why.
  std::vector<std::string> notes() const;

 private:
  struct Job {
    SweepInput input;
    Eigen::Quaterniond q_base_imu;
    std::optional<odometry::OdometryUpdate> update = {};
  };
  void start_next();
  void finish(const Job& job);

  /// Gyro and wheels of the last 3 s are remembered for the comparison, so few scans may wait.
  static constexpr std::size_t kWaitingScans = 5;

  agent::PerceptionConfig config_;
  bus::Bus& bus_;
  SampleCheck& check_;
  SweepInputs inputs_{kWaitingScans};
  std::shared_ptr<ScanOdometry> odometry_;  ///< touched by the work under way only; made with the first scan
  std::uint64_t scans_ = 0;
  bool busy_ = false;
};

}  // namespace fleetmap::apps
