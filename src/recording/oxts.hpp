#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <random>

#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/recording/reader.hpp"

namespace fleetmap::recording {

/// One record of KITTI's OXTS RT3003, as the samples of three sensors at base_link (x forward, y left, z up).
struct OxtsFrame {
  sensor::Imu imu;
  sensor::Fix fix;
  sensor::Wheel wheel;  ///< forward speed vf, yaw rate wz
};

/// Reads one file of oxts/data (30 numbers, KITTI raw devkit). Refuses what has fewer or non-finite numbers.
Result<OxtsFrame> read_oxts_file(const std::filesystem::path& file, Stamp stamp);

/// e(t + dt) = e(t) exp(-dt / tau) + sigma sqrt(1 - exp(-2 dt / tau)) n: the same errors for the same seed
/// and times.
class FixError {
 public:
  explicit FixError(const FixDegradation& config) : config_(config), engine_(config.seed) {}
  /// The fix with the error of its time added, and the error's sigma as its covariance.
  sensor::Fix degraded(const sensor::Fix& fix);

 private:
  double normal();
  FixDegradation config_;
  std::mt19937_64 engine_;
  std::optional<Stamp> last_;
  Eigen::Vector3d error_ = Eigen::Vector3d::Zero();  ///< m, ENU
};

}  // namespace fleetmap::recording
