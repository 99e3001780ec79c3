#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/agent/perception.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/odometry/loam.hpp"
#include "fleetmap/odometry/trajectory_check.hpp"
#include "fleetmap/output/trajectory_file.hpp"
#include "fleetmap/recording/play_times.hpp"
#include "fleetmap/recording/reader.hpp"

namespace fleetmap::apps {

/// Odometry alone over a recording, with the time that each scan took.
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

  /// True if the odometry never restarted its map and the trajectory has no warnings.
  bool kept_its_way() const { return counters.map_restarts == 0 && way.warnings().empty(); }
};

/// Called for samples of a recording, if they are set.
struct SampleObservers {
  std::function<void(const recording::Sample&)> as_read;
  /// Those that may be used, corrected where their clock or unit is wrong.
  std::function<void(const recording::Sample&)> as_used;
};

/// Runs the odometry over the whole recording. Fails if it cannot be read to its end.
Result<OdometryRun> run_odometry(recording::Reader& reader, const recording::LogClock& log_clock,
                                 const agent::PerceptionConfig& config,
                                 const SampleObservers& observers = {});

}  // namespace fleetmap::apps
