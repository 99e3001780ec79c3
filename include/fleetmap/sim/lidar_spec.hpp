#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fleetmap/core/result.hpp"

namespace fleetmap::sim {

/// Directions in which a LiDAR fires over time.
enum class FiringPattern : std::uint8_t {
  kSpinning,      ///< columns of rings, a revolution a scan
  kNonRepeating,  ///< a rosette that fills its field of view over time (Livox-like)
};

/// A LiDAR as its data sheet describes it. Angles in radians.
struct LidarSpec {
  std::string name = "vlp16";
  /// The odometry's model of it, by the name used in configurations.
  std::string model = "vlp16";
  FiringPattern pattern = FiringPattern::kSpinning;
  std::vector<double> vertical_angles;  ///< spinning: elevation of each ring, in firing order
  int columns = 1800;                   ///< spinning: firings of each ring a revolution
  bool clockwise = true;                ///< spinning, seen from above
  int rays = 24000;                     ///< non-repeating: rays a frame
  double field_of_view = 1.225;         ///< non-repeating: full cone, rad
  double rate = 10.0;                   ///< Hz, scans
  /// The lasers fire at a fixed rate (VLP-16, Livox): a slower scan has more columns or rays. Otherwise
  /// (Ouster) the columns of a revolution stay.
  bool fixed_firing_rate = false;
  double min_range = 0.5;          ///< m
  double max_range = 100.0;        ///< m, L_max of the device
  double range_noise = 0.02;       ///< m, 1 sigma
  double beam_divergence = 0.003;  ///< rad, full cone: a beam on an edge may return a range between
  double dropout = 0.002;          ///< share of rays lost anyway
  double glass_grazing = 1.31;     ///< rad from the normal, beyond which glass returns nothing
  Status validate() const;
};

/// A VLP-16 at 10 Hz.
LidarSpec vlp16_spec();

/// The same device turning at another rate, Hz.
LidarSpec at_rate(LidarSpec spec, double rate);

}  // namespace fleetmap::sim
