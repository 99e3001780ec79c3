#include "thinning.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include "fleetmap/cloud/voxel_grid.hpp"
#include "usable_point.hpp"

namespace fleetmap::eval {
cloud::PointCloud thinned(const cloud::PointCloud& cloud, double voxel) {
  cloud::VoxelMerger merger(static_cast<float>(voxel), cloud::VoxelPoint::first);
  merger.add(cloud);
  return merger.cloud();
}

cloud::PointCloud thinned_to(const cloud::PointCloud& cloud, double voxel, std::size_t max_points) {
  while (true) {
    cloud::VoxelMerger merger(static_cast<float>(voxel), cloud::VoxelPoint::first);
    merger.add(cloud);
    if (merger.voxels() <= max_points || voxel > kFarthest) return merger.cloud();  // eight voxels may stay
    voxel *= 1.5;
  }
}

cloud::PointCloud shuffled(cloud::PointCloud cloud) {
  std::mt19937_64 random(1);
  for (std::size_t i = cloud.size(); i > 1; --i) std::swap(cloud.points[i - 1], cloud.points[random() % i]);
  return cloud;
}

std::vector<Eigen::Vector3f> usable(const cloud::PointCloud& cloud, const Eigen::Vector3f& shift) {
  std::vector<Eigen::Vector3f> points;
  points.reserve(cloud.size());
  for (const Eigen::Vector3f& p : cloud.points) {
    if (is_usable(p)) points.push_back(p - shift);
  }
  return points;
}

std::vector<Eigen::Vector3f> evenly(const std::vector<Eigen::Vector3f>& points, std::size_t max_points) {
  const std::size_t step = points.size() / max_points + (points.size() % max_points != 0 ? 1u : 0u);
  if (step <= 1) return points;
  std::vector<Eigen::Vector3f> kept;
  kept.reserve(points.size() / step + 1);
  for (std::size_t i = 0; i < points.size(); i += step) kept.push_back(points[i]);
  return kept;
}

void sort_by_place(std::vector<Eigen::Vector3f>& points) {
  constexpr float kCell = 4.0f;  // m
  struct Keyed {
    std::uint64_t cell;
    std::uint32_t index;
  };
  const auto ordered = [](float x) {  // as the numbers are, from 0
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::floor(x / kCell))) ^ 0x80000000u;
  };
  std::vector<Keyed> order(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    order[i] = {std::uint64_t{ordered(points[i].x())} << 32 | ordered(points[i].y()),
                static_cast<std::uint32_t>(i)};
  }
  std::sort(order.begin(), order.end(), [](const Keyed& a, const Keyed& b) {
    return a.cell != b.cell ? a.cell < b.cell : a.index < b.index;
  });
  std::vector<Eigen::Vector3f> sorted;
  sorted.reserve(points.size());
  for (const Keyed& k : order) sorted.push_back(points[k.index]);
  points = std::move(sorted);
}

Eigen::Vector3f middle_of(const cloud::PointCloud& cloud) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  std::size_t count = 0;
  for (const Eigen::Vector3f& p : cloud.points) {
    if (!is_usable(p)) continue;
    sum += p.cast<double>();
    ++count;
  }
  if (count == 0) return Eigen::Vector3f::Zero();
  return (sum / static_cast<double>(count)).array().round().cast<float>();
}

}  // namespace fleetmap::eval
