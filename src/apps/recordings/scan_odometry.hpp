#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/agent/perception_config.hpp"
#include "fleetmap/odometry/loam.hpp"
#include "fleetmap/odometry/trajectory_check.hpp"
#include "fleetmap/output/trajectory_file.hpp"
#include "fleetmap/sensor/turn_direction.hpp"
#include "sweep_inputs.hpp"

namespace fleetmap::apps {

/// Odometry alone, with the time that each scan took.
struct OdometryRun {
  output::Trajectory poses;
  std::vector<double> wall_ms;
  double cpu_s = 0.0;
  std::size_t refused = 0;
  std::string first_refusal;
  std::optional<Stamp> first_lost;
  odometry::LoamCounters counters;
  odometry::LocalMapSize map;  ///< when it was largest
  std::size_t blind = 0;       ///< scans that left a direction of the motion to the prior
  odometry::TrajectoryCheck way;
  std::vector<std::string> findings;  ///< about clocks, units, rates, mounts and motions
  std::vector<std::string> notes;     ///< that are no findings: gaps

  /// True if the odometry never restarted its map and the trajectory has no warnings.
  bool kept_its_way() const { return counters.map_restarts == 0 && way.warnings().empty(); }
  /// Sentences on what the odometry itself could not do with `scans` scans.
  std::vector<std::string> failures(std::size_t scans) const;
};

/// The odometry of a recording or of a live robot's scans, without the rest of an agent.
class ScanOdometry {
 public:
  /// `config` as it is when the mount of the LiDAR is decided.
  explicit ScanOdometry(const agent::PerceptionConfig& config);
  void set_imu_rotation(const Eigen::Quaterniond& q_base_imu);
  /// Empty if the scan was refused.
  std::optional<odometry::OdometryUpdate> add(const SweepInput& input);
  /// Findings since the last call, of the odometry and of TurnDirection.
  std::vector<std::string> take_findings();
  /// Without findings.
  const OdometryRun& run() const { return run_; }

 private:
  Result<odometry::OdometryUpdate> timed(const sensor::Scan& scan);
  void check_turns(const SweepInput& input);

  bool uses_imu_, uses_wheel_;
  odometry::Loam loam_;
  sensor::TurnDirection turns_;
  OdometryRun run_;
  std::vector<std::string> findings_;
};

}  // namespace fleetmap::apps
