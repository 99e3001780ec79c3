#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/sensor/scan.hpp"
#include "fleetmap/sim/scene.hpp"

namespace fleetmap::sim {

struct ScanJob;  // robot_twin.hpp

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

/// One scan of `spec`: every ray cast from the pose at its own firing time. Pure; the noise comes from
/// job.seed and job.number alone. Empty if `spec` breaks a rule or `job` has less than two finite poses.
///
/// Spinning: the revolution starts at the rear (azimuth pi); all rings of a column fire together, columns
/// follow one another evenly over 1 / rate; points come column by column, ring = index of vertical_angles.
/// Non-repeating: the path that two counter-turning prisms draw around the x axis, going on from scan to
/// scan. Besides the ray along the beam's axis a second one is cast somewhere within its divergence. Where
/// both meet different surfaces less than a pulse's length apart, the range lies between the two; farther
/// apart the axis decides; where the axis meets nothing, the rim's weak echo comes back every second time.
/// Intensity 0 to 255: reflectivity of the material by the cosine of incidence, less with range.
sensor::Scan cast_scan(const Scene& scene, const LidarSpec& spec, const ScanJob& job);

/// Firings of a scan: columns of a spinning LiDAR, rays of a non-repeating one.
std::size_t firings(const LidarSpec& spec);
/// How many of them `job` of a scan under way has the poses of, so that they can be cast already.
std::size_t firings_known(const LidarSpec& spec, const ScanJob& job);
/// The points of the firings [first, end): those of cast_scan(), in parts. `first` and `end` are 0, results
/// of firings_known() or firings().
std::vector<sensor::ScanPoint> cast_firings(const Scene& scene, const LidarSpec& spec, const ScanJob& job,
                                            std::size_t first, std::size_t end);

}  // namespace fleetmap::sim
