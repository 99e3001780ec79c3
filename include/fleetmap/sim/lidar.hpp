#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/sensor/scan.hpp"
#include "fleetmap/sim/lidar_spec.hpp"
#include "fleetmap/sim/scene.hpp"

namespace fleetmap::sim {

struct ScanJob;  // robot_twin.hpp

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
/// The number of firings whose poses `job` of an unfinished scan already has, so that they can be cast.
std::size_t firings_ready(const LidarSpec& spec, const ScanJob& job);
/// The points of the firings [first, end): those of cast_scan(), in parts. `first` and `end` are 0, results
/// of firings_ready() or firings().
std::vector<sensor::ScanPoint> cast_firings(const Scene& scene, const LidarSpec& spec, const ScanJob& job,
                                            std::size_t first, std::size_t end);

}  // namespace fleetmap::sim
