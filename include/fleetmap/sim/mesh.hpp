#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace fleetmap::sim {

/// What a surface is made of: how a LiDAR sees it.
enum class Material : std::uint8_t { kGround, kGlass, kMetal, kConcrete, kVegetation };

/// Triangles in the site's ENU frame, metres. A triangle is seen from both sides.
struct Mesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Material> materials;  ///< one a triangle

  bool empty() const { return triangles.empty(); }
};

/// Adds the triangles of `other` behind those of `mesh`.
void append(Mesh& mesh, const Mesh& other);

}  // namespace fleetmap::sim
