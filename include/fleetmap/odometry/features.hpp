#pragma once

#include <cstdint>
#include <vector>

#include "fleetmap/odometry/loam_config.hpp"
#include "fleetmap/odometry/sweep.hpp"

namespace fleetmap::odometry {

/// Indices into Sweep::points.
struct Features {
  std::vector<std::uint32_t> edges;   ///< corners, posts and borders against the background
  std::vector<std::uint32_t> planes;  ///< smooth surface; without rings all points
};

/// Curvature features along each ring, after Zhang and Singh, LOAM (RSS 2014), section V-A, with two changes:
/// the neighbourhood is a length of surface rather than a number of points, so near and far surfaces and
/// dense and sparse LiDARs are judged alike; narrow objects in front of a background (posts) are edges.
class FeatureExtractor {
 public:
  explicit FeatureExtractor(const LoamConfig& config);
  /// The features stay valid until the next call.
  const Features& extract(const Sweep& sweep);

 private:
  void measure_ring(const Sweep& sweep, std::size_t ring);
  void find_breaks(std::span<const SweepPoint> points);
  void select_plane_points(std::size_t begin, std::size_t count);
  void select_bends(std::size_t begin, std::size_t count);
  void select_posts(std::span<const SweepPoint> points, std::size_t begin);

  double half_width_, plane_max_deviation_, edge_min_deviation_, edge_min_angle_;
  Features features_;
  std::vector<Eigen::Vector3d> sums_;       ///< prefix sums of the ring's positions about its first point
  std::vector<float> deviation_, bend_;     ///< m off the chord; rad; negative where not defined
  std::vector<std::uint8_t> half_count_;    ///< neighbours used on either side
  std::vector<std::uint32_t> segment_end_;  ///< one past the last point of the point's unbroken segment
  std::vector<std::uint32_t> segment_begin_;
};

}  // namespace fleetmap::odometry
