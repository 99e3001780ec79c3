#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "fleetmap/cloud/point_cloud.hpp"

namespace fleetmap::eval {

/// Points that are finite and not absurdly far away, moved by -shift.
std::vector<Eigen::Vector3f> usable(const cloud::PointCloud& cloud, const Eigen::Vector3f& shift);
/// Mean of the usable points, rounded to metres.
Eigen::Vector3f middle_of(const cloud::PointCloud& cloud);

/// The first point of each voxel of that edge (m).
cloud::PointCloud thinned(const cloud::PointCloud& cloud, double voxel);
/// One point in each voxel, of voxels that are as large as it takes.
cloud::PointCloud thinned_to(const cloud::PointCloud& cloud, double voxel, std::size_t max_points);
/// Points at even steps, at most `most` of them.
std::vector<Eigen::Vector3f> evenly(const std::vector<Eigen::Vector3f>& points, std::size_t max_points);
/// In an order that has nothing to do with their places, always the same.
cloud::PointCloud shuffled(cloud::PointCloud cloud);
/// Neighbours in space become neighbours in memory: searches meet fewer cold cache lines.
void sort_by_place(std::vector<Eigen::Vector3f>& points);

}  // namespace fleetmap::eval
