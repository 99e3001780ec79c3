#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "fleetmap/cloud/point_cloud.hpp"

namespace fleetmap::sim {

/// The material of a surface, which determines its LiDAR returns.
enum class Material : std::uint8_t { kGround, kGlass, kMetal, kConcrete, kVegetation };
inline constexpr int kMaterials = 5;

/// Triangles in the site's ENU frame, metres. A triangle is seen from both sides.
struct Mesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Material> materials;  ///< one a triangle

  bool empty() const { return triangles.empty(); }
};

/// Adds the triangles of `other` behind those of `mesh`.
void append(Mesh& mesh, const Mesh& other);

/// m^2 of all triangles together.
double area(const Mesh& mesh);

/// Points spread evenly over all triangles, `points_per_m2` of them on average: the ground truth of a map.
/// Stratified along the triangles' order, so that every patch gets its share; the same seed yields the same
/// points. Empty for a density that is not positive; the density is reduced where it would yield more than
/// `max_points`.
cloud::PointCloud sample_surface(const Mesh& mesh, double points_per_m2, std::uint64_t seed,
                                 std::size_t max_points = 50'000'000);

}  // namespace fleetmap::sim
