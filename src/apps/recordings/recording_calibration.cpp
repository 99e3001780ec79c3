#include "recording_calibration.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <ostream>
#include <string>
#include <vector>

#include "calibrated_mounts.hpp"
#include "calibration_report.hpp"
#include "fleetmap/sensor/calibration_drive.hpp"
#include "odometry_run.hpp"
#include "recording_input.hpp"

namespace fleetmap::apps {
namespace {

/// Keeps what calibration uses. Stamps that do not increase, of a driver that repeats itself, are left out.
struct DriveCollector {
  sensor::CalibrationDrive& drive;
  void operator()(const sensor::Scan&) const {}
  void operator()(const sensor::Imu& imu) const { keep(drive.imu, imu); }
  void operator()(const sensor::Fix& fix) const { keep(drive.fixes, fix); }
  void operator()(const sensor::Wheel& wheel) const { keep(drive.wheels, wheel); }

  template <class T>
  static void keep(std::vector<T>& all, const T& sample) {
    if (all.empty() || sample.stamp > all.back().stamp) all.push_back(sample);
  }
};

/// The motion must not follow sensors whose mounts are estimated by it.
agent::PerceptionConfig lidar_alone(agent::PerceptionConfig config) {
  config.odometry_uses_imu = config.odometry_uses_wheel = false;
  return config;
}

Result<sensor::CalibrationDrive> drive_of(RecordingInput& input) {
  sensor::CalibrationDrive drive;
  const auto collect = [&](const recording::Sample& sample) { std::visit(DriveCollector{drive}, sample); };
  const agent::PerceptionConfig config = lidar_alone(input.config.agent.perception);
  const auto run = run_odometry(*input.reader, input.prepared.log_clock, config, {{}, collect});
  if (!run) return tl::unexpected(run.error());
  for (const std::string& finding : run->findings) spdlog::warn("{}", finding);
  if (run->poses.empty()) return failure("no scan could be used: " + run->first_refusal);
  if (!run->kept_its_way()) {
    return failure(
        "the odometry by LiDAR alone lost its way, so that nothing can be compared with it: drive slower, "
        "among walls, trees or houses");
  }
  for (const auto& pose : run->poses) drive.track.push_back({pose.stamp, pose.T_w_base});
  return drive;
}

}  // namespace

CommandResult<ExitCode> calibrate_recording(const CalibrateOptions& options, std::ostream& out) {
  auto input = open_recording(options.input);
  if (!input) return tl::unexpected(input.error());
  log_preparation(input->prepared);
  const auto drive = drive_of(*input);
  if (!drive) return exit_with(kFailed, {options.input.recording + ": " + drive.error().message});
  const agent::PerceptionConfig& config = input->config.agent.perception;
  const CalibratedMounts mounts =
      calibrate_mounts(*drive, {config.odometry.T_base_lidar, config.localization.mounting.T_base_imu,
                                config.localization.mounting.p_base_antenna});
  if (options.json) {
    print_calibration_json(out, mounts);
  } else {
    print_calibration(out, mounts);
  }
  return std::ranges::any_of(mounts.quantities, &CalibratedQuantity::observable) ? kDone : kFailed;
}

}  // namespace fleetmap::apps
