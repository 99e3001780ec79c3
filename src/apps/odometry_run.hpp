#pragma once

#include <functional>

#include "fleetmap/agent/perception_config.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/recording/play_times.hpp"
#include "fleetmap/recording/reader.hpp"
#include "scan_odometry.hpp"

namespace fleetmap::apps {

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
