#pragma once

#include <optional>

#include "fleetmap/agent/drive_guard_config.hpp"
#include "fleetmap/core/time.hpp"

namespace fleetmap::agent {

/// Reason for which a robot must stand still.
enum class StopReason {
  kStopping,    ///< the process is ending
  kHeld,        ///< an operator's order
  kNoScan,      ///< the LiDAR is silent
  kNoOdometry,  ///< scans come, but the odometry is lost or too slow
  kNoPose,      ///< neither G with a small enough covariance nor a guide
};
const char* to_string(StopReason reason);

/// Decides whether a robot may be driven, from the arrival times of its scans and poses. Pure: all times are
/// arguments. If the clock is set back, earlier scans and poses count as missing.
class DriveGuard {
 public:
  /// check() has to be called at least this often.
  static constexpr Duration kPeriod = std::chrono::milliseconds(20);

  explicit DriveGuard(const DriveGuardConfig& config = {}) : config_(config) {}

  void on_scan(Stamp now) { scan_ = now; }
  /// The odometry matched the scan that arrived at `arrival`.
  void on_odometry(Stamp arrival, Stamp now);
  /// A pose of the robot on the site arrived.
  void on_pose(Stamp now) { pose_ = now; }
  void set_held(bool held) { held_ = held; }
  bool held() const { return held_; }
  /// For good.
  void stop() { stopping_ = true; }

  /// Nothing if the robot may be driven.
  std::optional<StopReason> check(Stamp now);
  const DriveGuardConfig& config() const { return config_; }

 private:
  bool overdue(const std::optional<Stamp>& last, Stamp now) const;

  DriveGuardConfig config_;
  std::optional<Stamp> scan_, odometry_, pose_, checked_;
  bool held_ = false;
  bool stopping_ = false;
};

}  // namespace fleetmap::agent
