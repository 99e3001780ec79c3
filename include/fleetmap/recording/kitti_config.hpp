#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

namespace fleetmap::recording {

/// Degrades a good position to that of a cheap receiver: a first-order Gauss-Markov error on each ENU axis.
struct FixDegradation {
  double sigma = 1.5;              ///< m, standard deviation of each axis; reported as the fix's covariance
  double correlation_time = 60.0;  ///< s
  std::uint64_t seed = 1;
};

/// Folders of scans as KITTI keeps them.
struct KittiConfig {
  std::size_t first_frame = 0;
  std::size_t last_frame = std::numeric_limits<std::size_t>::max();  ///< inclusive
  double nominal_rate = 10.0;  ///< frames/s without a file of times; frame k is then at k / rate
  std::optional<FixDegradation> fix_degradation;
  bool wheel_yaw_rate = false;  ///< report the gyro's yaw rate as the wheels', too
};

}  // namespace fleetmap::recording
