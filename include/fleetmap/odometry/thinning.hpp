#pragma once

#include <cstdint>
#include <vector>

#include "fleetmap/odometry/flat_index.hpp"
#include "fleetmap/odometry/scan_matching.hpp"
#include "fleetmap/odometry/sweep.hpp"

namespace fleetmap::odometry {

/// One point per cube, the first that comes; keeps its tables between calls.
class Thinning {
 public:
  explicit Thinning(double spacing) : inverse_(1.0 / spacing) {}

  /// Brings what first_in_cube(p) reads into the caches.
  void prefetch(const Eigen::Vector3f& p) const { cubes_.prefetch(cube_of(p)); }
  bool first_in_cube(const Eigen::Vector3f& p) {
    const std::uint32_t before = cubes_.size();
    return cubes_.insert(cube_of(p)) == before;
  }
  void clear() { cubes_.clear(); }

 private:
  CellKey cube_of(const Eigen::Vector3f& p) const {
    return pack_cell(fast_floor(p.x() * inverse_), fast_floor(p.y() * inverse_),
                     fast_floor(p.z() * inverse_));
  }

  double inverse_;
  FlatIndex cubes_;
};

}  // namespace fleetmap::odometry
