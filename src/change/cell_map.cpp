#include "cell_map.hpp"

#include <algorithm>
#include <cmath>

#include "fleetmap/cloud/voxel_grid.hpp"

namespace fleetmap::change {

CellMap::CellMap(const std::vector<const ObservedSubmap*>& submaps, double cell_m) : submaps_(submaps) {
  CellIndex index;
  for (const ObservedSubmap* submap : submaps) {
    for (const Eigen::Vector3f& point :
         cloud::voxel_downsample(submap->points, static_cast<float>(cell_m)).points) {
      const auto voxel = cloud::voxel_of(point, cell_m);
      if (!voxel) continue;
      const auto [found, added] = index.try_emplace(*voxel, static_cast<std::uint32_t>(cells_.size()));
      if (added) cells_.emplace_back();
      Cell& cell = cells_[found->second];
      ++cell.submaps;
      cell.centre += (point - cell.centre) / static_cast<float>(cell.submaps);
    }
  }
  std::vector<Eigen::Vector3f> centres;
  centres.reserve(cells_.size());
  for (const Cell& cell : cells_) centres.push_back(cell.centre);
  tree_.emplace(centres);
}

float CellMap::distance(const Eigen::Vector3f& point, float reach) const {
  const auto nearest = tree_->nearest(point, reach);
  return nearest ? std::sqrt(nearest->squared_distance) : reach;
}

bool CellMap::has_level(const Eigen::Vector3f& point, float radius, float tolerance) const {
  return std::ranges::any_of(tree_->radius(point, radius), [&](const cloud::Neighbor& near) {
    return std::abs(cells_[near.index].centre.z() - point.z()) <= tolerance;
  });
}

}  // namespace fleetmap::change
