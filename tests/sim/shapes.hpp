#pragma once

#include <Eigen/Core>
#include <functional>

#include "fleetmap/sim/mesh.hpp"

namespace fleetmap::sim {

/// Ground of height(x, y) as triangles of half a metre, from `low` to `high`.
inline Mesh test_ground(const Eigen::Vector2d& low, const Eigen::Vector2d& high,
                        const std::function<double(double, double)>& height) {
  Mesh mesh;
  const Eigen::Vector2i cells = ((high - low) / 0.5).array().ceil().cast<int>();
  for (int row = 0; row <= cells.y(); ++row) {
    for (int column = 0; column <= cells.x(); ++column) {
      const Eigen::Vector2d p =
          low + (high - low)
                    .cwiseProduct(Eigen::Vector2d(static_cast<double>(column) / cells.x(),
                                                  static_cast<double>(row) / cells.y()));
      mesh.vertices.emplace_back(Eigen::Vector3d(p.x(), p.y(), height(p.x(), p.y())).cast<float>());
    }
  }
  const auto at = [&](int column, int row) {
    return static_cast<std::uint32_t>(row * (cells.x() + 1) + column);
  };
  for (int row = 0; row < cells.y(); ++row) {
    for (int column = 0; column < cells.x(); ++column) {
      mesh.triangles.push_back({at(column, row), at(column + 1, row), at(column + 1, row + 1)});
      mesh.triangles.push_back({at(column, row), at(column + 1, row + 1), at(column, row + 1)});
    }
  }
  mesh.materials.assign(mesh.triangles.size(), Material::kGround);
  return mesh;
}

inline Mesh test_box(const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                     Material material = Material::kConcrete) {
  Mesh mesh;
  for (int k = 0; k < 8; ++k) {
    mesh.vertices.emplace_back(Eigen::Vector3d((k & 1) != 0 ? high.x() : low.x(),
                                               (k & 2) != 0 ? high.y() : low.y(),
                                               (k & 4) != 0 ? high.z() : low.z())
                                   .cast<float>());
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  mesh.materials.assign(mesh.triangles.size(), material);
  return mesh;
}

}  // namespace fleetmap::sim
