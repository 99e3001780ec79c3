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

  bool first_in_cube(const Eigen::Vector3f& p) {
    const std::uint32_t before = cubes_.size();
    return cubes_.insert(pack_cell(fast_floor(p.x() * inverse_), fast_floor(p.y() * inverse_),
                                   fast_floor(p.z() * inverse_))) == before;
  }
  void clear() { cubes_.clear(); }

 private:
  double inverse_;
  FlatIndex cubes_;
};

}  // namespace fleetmap::odometry
