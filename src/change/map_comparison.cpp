#include "map_comparison.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include "fleetmap/cloud/kd_tree.hpp"
#include "ray_evidence.hpp"

namespace fleetmap::change {
namespace {

/// Free cells of the other session within this many cells of each other are one object, because rays leave
/// gaps.
constexpr double kGap = 3.5;
/// Unobserved points within this distance of a cell that the other session saw through belong to the same
/// object.
constexpr float kHidden = 2.0f;  // m
/// A cell as high as a surface of the other day within this distance is taken for more of that surface:
/// ground between two rings of the LiDAR.
constexpr float kSameSurface = 1.5f;  // m

using Points = std::vector<Eigen::Vector3f>;

std::vector<FreeCluster> clusters_of(const Points& free, const ChangeConfig& config) {
  const cloud::KdTree tree(free);
  const auto gap = static_cast<float>(kGap * config.cell_m);
  std::vector<char> taken(free.size(), 0);
  std::vector<FreeCluster> clusters;
  for (std::size_t seed = 0; seed < free.size(); ++seed) {
    if (taken[seed]) continue;
    taken[seed] = 1;
    FreeCluster cluster{{free[seed]}, 0};
    for (std::size_t k = 0; k < cluster.points.size(); ++k) {
      for (const cloud::Neighbor& near : tree.radius(cluster.points[k], gap)) {
        if (std::exchange(taken[near.index], 1)) continue;
        cluster.points.push_back(free[near.index]);
      }
    }
    cluster.traversed = cluster.points.size();
    clusters.push_back(std::move(cluster));
  }
  return clusters;
}

/// Adds each cell that was not seen, and is no ground, to the cluster of the nearest cell that was seen
/// through.
void add_hidden(const Points& unobserved, const CellMap& other, const ChangeConfig& config,
                std::vector<FreeCluster>& clusters) {
  Points free;
  std::vector<std::size_t> cluster_of;
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    free.insert(free.end(), clusters[k].points.begin(), clusters[k].points.end());
    cluster_of.resize(free.size(), k);
  }
  const cloud::KdTree tree(free);
  for (const Eigen::Vector3f& point : unobserved) {
    const auto nearest = tree.nearest(point, kHidden);
    if (!nearest || other.has_level(point, kSameSurface, 1.25f * static_cast<float>(config.cell_m))) continue;
    clusters[cluster_of[nearest->index]].points.push_back(point);
  }
}

}  // namespace

MapComparison compare(const CellMap& map, const CellMap& other, const NoiseModel& noise,
                      const ChangeConfig& config) {
  MapComparison result;
  Points unmatched;
  std::vector<std::uint32_t> hits;
  const auto margin = static_cast<float>(2.0 * config.cell_m);
  for (const CellMap::Cell& cell : map.cells()) {
    if (cell.submaps < config.min_submaps) continue;
    const float min_distance = noise.min_distance(cell.centre);
    if (other.distance(cell.centre, static_cast<float>(config.reach_m)) < min_distance) {
      result.same.push_back(cell.centre);
    } else {
      unmatched.push_back(cell.centre);
      hits.push_back(cell.submaps);
    }
  }
  const RayEvidence evidence(unmatched, config.cell_m, margin);
  const std::vector<std::uint32_t> through = evidence.passes(other.submaps());
  const std::vector<std::uint32_t> by_own_day = evidence.passes(map.submaps());
  Points free;
  for (std::size_t k = 0; k < unmatched.size(); ++k) {
    if (by_own_day[k] >= hits[k]) continue;  // it moved, or rays pass between its leaves
    (through[k] >= config.min_submaps ? free : result.unobserved).push_back(unmatched[k]);
  }
  result.traversed = free.size();
  result.free = clusters_of(free, config);
  add_hidden(result.unobserved, other, config, result.free);
  std::ranges::stable_sort(result.free, std::greater{}, &FreeCluster::traversed);
  return result;
}

}  // namespace fleetmap::change
