#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "fleetmap/odometry/flat_index.hpp"

namespace fleetmap::odometry {

/// One point per cube, the first that comes; keeps its tables between calls.
class Thinning {
 public:
  explicit Thinning(double spacing) : inverse_(1.0 / spacing) {}

  bool first_in_cube(const Eigen::Vector3f& p) { return first(cube_of(p)); }

  /// `visit(k)` for each k < count whose `position(k)` is the first in its cube. Neighbours on a ring mostly
  /// share one, and the table is larger than the caches, so the places of many cubes are fetched at a time.
  template <class Position, class Visit>
  void for_each_first(std::size_t count, const Position& position, const Visit& visit) {
    constexpr std::size_t kBlock = 32;
    std::array<std::pair<CellKey, std::size_t>, kBlock> cubes;
    CellKey last = 0;  // of no cube near the robot
    for (std::size_t k = 0; k < count;) {
      std::size_t found = 0;
      for (; k < count && found < kBlock; ++k) {
        const CellKey cube = cube_of(position(k));
        if (cube == last) continue;
        last = cube;
        cubes_.prefetch(cube);
        cubes[found++] = {cube, k};
      }
      for (std::size_t i = 0; i < found; ++i) {
        if (first(cubes[i].first)) visit(cubes[i].second);
      }
    }
  }
  void clear() { cubes_.clear(); }

 private:
  bool first(CellKey cube) {
    const std::uint32_t before = cubes_.size();
    return cubes_.insert(cube) == before;
  }
  CellKey cube_of(const Eigen::Vector3f& p) const {
    return pack_cell(fast_floor(p.x() * inverse_), fast_floor(p.y() * inverse_),
                     fast_floor(p.z() * inverse_));
  }

  double inverse_;
  FlatIndex cubes_;
};

}  // namespace fleetmap::odometry
