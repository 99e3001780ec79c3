#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::cloud {

/// Points of one frame, in metres. `intensities` is either empty or as long as `points`.
struct PointCloud {
  std::vector<Eigen::Vector3f> points;
  std::vector<float> intensities;

  std::size_t size() const { return points.size(); }
  bool empty() const { return points.empty(); }
  bool has_intensities() const { return !intensities.empty(); }
};

/// The same points in frame a. Intensities are kept.
PointCloud transformed(const PointCloud& cloud_b, const Pose& T_a_b);
/// Appends `other`; intensities survive only if both have them (or the first is empty).
void append(PointCloud& cloud, const PointCloud& other);
/// Copies the points at `indices`, in that order.
PointCloud select(const PointCloud& cloud, const std::vector<std::size_t>& indices);
/// Drops points with a NaN or infinite coordinate; returns how many there were.
std::size_t remove_non_finite(PointCloud& cloud);

}  // namespace fleetmap::cloud
