#pragma once

#include <optional>

#include "fleetmap/core/time.hpp"

namespace fleetmap::agent {

/// Why a robot has to stand still.
enum class StandReason {
  kStopping,    ///< the process was told to stop
  kHeld,        ///< an operator's order
  kNoScan,      ///< the LiDAR is silent
  kNoOdometry,  ///< scans come, but the odometry is lost or too slow
  kNoPose,      ///< neither G, well enough, nor another tells where the robot is
};
const char* to_string(StandReason reason);

struct DriveGuardConfig {
  /// Since the last scan, since the odometry's last result and since the last pose. A LiDAR of 5 Hz may be
  /// 60 ms late; with kPeriod the robot is told to stand at most 280 ms after the last of either, which
  /// leaves 20 ms to the promised 300 ms.
  Duration patience = std::chrono::milliseconds(260);
  /// From the arrival of a scan to the odometry's result: one that comes later is none.
  Duration max_latency = std::chrono::milliseconds(300);
  double max_position_sigma = 5.0;  ///< m, horizontal, 1 sigma of G; beyond, the robot does not know its lane
};

/// Decides at any time whether a robot may be driven, from when its scans and poses came. Pure: all times are
/// given. When the clock is set back, scans and poses before count as missing.
class DriveGuard {
 public:
  /// check() has to be called at least this often.
  static constexpr Duration kPeriod = std::chrono::milliseconds(20);

  explicit DriveGuard(const DriveGuardConfig& config = {}) : config_(config) {}

  void on_scan(Stamp now) { scan_ = now; }
  /// The odometry has fitted the scan that came at `arrival`.
  void on_odometry(Stamp arrival, Stamp now);
  /// The robot's pose on the site came.
  void on_pose(Stamp now) { pose_ = now; }
  void set_held(bool held) { held_ = held; }
  bool held() const { return held_; }
  /// For good.
  void stop() { stopping_ = true; }

  /// Nothing if the robot may be driven.
  std::optional<StandReason> check(Stamp now);
  const DriveGuardConfig& config() const { return config_; }

 private:
  bool overdue(const std::optional<Stamp>& last, Stamp now) const;

  DriveGuardConfig config_;
  std::optional<Stamp> scan_, odometry_, pose_, checked_;
  bool held_ = false;
  bool stopping_ = false;
};

}  // namespace fleetmap::agent
