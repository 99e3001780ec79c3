#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <unordered_set>
#include <vector>

#include "cell_map.hpp"

namespace fleetmap::change {

/// Counts, for some cells, the submaps whose rays passed through them to surfaces behind.
class RayEvidence {
 public:
  /// `points`: one in each cell of interest. A ray is evidence up to `margin` m before its end.
  RayEvidence(const std::vector<Eigen::Vector3f>& points, double cell_m, float margin);

  /// Submaps that saw through the cell of each point.
  std::vector<std::uint32_t> passes(const std::vector<const ObservedSubmap*>& submaps) const;

 private:
  template <class Visitor>
  void visit(const Eigen::Vector3f& from, const Eigen::Vector3f& to, Visitor visitor) const;
  bool near_cells(const Eigen::Vector3f& point) const;

  double cell_m_;
  float margin_;
  std::vector<Eigen::Vector3f> points_;
  CellIndex index_;
  std::unordered_set<cloud::Voxel, VoxelHash> blocks_;  ///< with a cell in or beside them
};

}  // namespace fleetmap::change
