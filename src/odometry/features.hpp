#pragma once

#include <cstdint>
#include <vector>

#include "fleetmap/odometry/loam_config.hpp"
#include "sweep.hpp"

namespace fleetmap::odometry {

/// A feature in base_link at its moment of firing.
struct FeaturePoint {
  Eigen::Vector3f position;  ///< m
  float time = 0.0f;         ///< s after the sweep's reference instant
  float noise = 0.0f;        ///< m, 1 sigma of an edge's place that comes from the spacing of the rays
};

struct Features {
  std::vector<FeaturePoint> edges;  ///< axes of posts and borders against the background
  std::vector<std::uint32_t>
      planes;  ///< indices into Sweep::points: smooth surface; without rings all points
};

/// Curvature features along each ring, after Zhang and Singh, LOAM (RSS 2014), section V-A, with these
/// changes: the neighbourhood is a length of surface rather than a number of points, so near and far surfaces
/// and dense and sparse LiDARs are treated alike; posts and the borders of surfaces in front of a background
/// are edges, but no corners: the sharpest of noisy points is no place, and both their surfaces count. Edges
/// are placed where they look the same from all sides, or a map of them would be dragged along by the robot
/// that passes them: a post at its axis, a border half a ray's spacing beyond its last return.
class FeatureExtractor {
 public:
  explicit FeatureExtractor(const LoamConfig& config);
  /// The features stay valid until the next call.
  const Features& extract(const Sweep& sweep);

 private:
  bool trace(std::span<const SweepPoint> points);
  void measure(std::span<const SweepPoint> points);
  void find_breaks(std::span<const SweepPoint> points);
  void select_plane_points(std::size_t begin, std::size_t count);
  void select_posts(std::span<const SweepPoint> points);
  void select_borders(std::span<const SweepPoint> points);
  void add_border(std::span<const SweepPoint> points, const SweepPoint& behind, int inwards);

  double half_width_, plane_max_deviation_;
  Eigen::Vector3f lidar_;  ///< m, in base_link
  Features features_;
  std::vector<Eigen::Vector3d> sums_;       ///< prefix sums of the ring's positions about its first point
  std::vector<float> deviation_;            ///< m off the chord; negative where not defined
  std::vector<std::uint32_t> segment_end_;  ///< one past the last point of the point's unbroken segment
  std::vector<std::uint32_t> segment_begin_;
};

}  // namespace fleetmap::odometry
