#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "fleetmap/change/find_changes.hpp"
#include "fleetmap/cloud/kd_tree.hpp"
#include "fleetmap/cloud/voxel.hpp"

namespace fleetmap::change {

struct VoxelHash {
  std::size_t operator()(const cloud::Voxel& voxel) const { return cloud::hash_of(voxel); }
};
using CellIndex = std::unordered_map<cloud::Voxel, std::uint32_t, VoxelHash>;

/// The surfaces that some submaps saw, by cells.
class CellMap {
 public:
  struct Cell {
    Eigen::Vector3f centre = Eigen::Vector3f::Zero();  ///< mean of its points
    std::uint32_t submaps = 0;                         ///< that hit it
  };

  CellMap(const std::vector<const ObservedSubmap*>& submaps, double cell_m);

  const std::vector<const ObservedSubmap*>& submaps() const { return submaps_; }
  const std::vector<Cell>& cells() const { return cells_; }
  /// m, to the nearest cell; `reach` if there is none nearer.
  float distance(const Eigen::Vector3f& point, float reach) const;
  /// A cell within `radius` m is as high as `point`, to `tolerance` m: it may be of the same ground.
  bool has_level(const Eigen::Vector3f& point, float radius, float tolerance) const;

 private:
  std::vector<const ObservedSubmap*> submaps_;
  std::vector<Cell> cells_;
  std::optional<cloud::KdTree> tree_;
};

}  // namespace fleetmap::change
