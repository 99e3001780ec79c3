#include "fleetmap/sim/mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "counter_random.hpp"

namespace fleetmap::sim {
namespace {

struct Corners {
  Eigen::Vector3d a, b, c;
};

Corners corners_of(const Mesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return {mesh.vertices[a].cast<double>(), mesh.vertices[b].cast<double>(), mesh.vertices[c].cast<double>()};
}

double area_of(const Corners& t) { return 0.5 * (t.b - t.a).cross(t.c - t.a).norm(); }

/// Uniform over the triangle for uniform u, v in [0, 1).
Eigen::Vector3d point_in(const Corners& t, double u, double v) {
  const double root = std::sqrt(u);
  return (1.0 - root) * t.a + root * (1.0 - v) * t.b + root * v * t.c;
}

}  // namespace

void append(Mesh& mesh, const Mesh& other) {
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  mesh.triangles.reserve(mesh.triangles.size() + other.triangles.size());
  for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({a + base, b + base, c + base});
  mesh.materials.insert(mesh.materials.end(), other.materials.begin(), other.materials.end());
}

double area(const Mesh& mesh) {
  double sum = 0.0;
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k) sum += area_of(corners_of(mesh, k));
  return sum;
}

cloud::PointCloud sample_surface(const Mesh& mesh, double points_per_m2, std::uint64_t seed,
                                 std::size_t max_points) {
  cloud::PointCloud cloud;
  const double total = area(mesh);
  if (!(points_per_m2 > 0.0) || !(total > 0.0) || !std::isfinite(total) || max_points == 0) return cloud;
  const double wanted = std::min(total * points_per_m2, static_cast<double>(max_points));
  const double spacing = total / wanted;  // m^2 a point
  cloud.points.reserve(static_cast<std::size_t>(wanted) + 1);
  // Points lie at equal steps of summed area, after a random offset.
  double next = spacing * uniform_at(seed, 0);
  double passed = 0.0;
  std::uint64_t number = 0;
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
    const Corners triangle = corners_of(mesh, k);
    passed += area_of(triangle);
    for (; next < passed && cloud.size() < max_points; next += spacing) {
      ++number;
      cloud.points.push_back(
          point_in(triangle, uniform_at(seed, number, 1), uniform_at(seed, number, 2)).cast<float>());
    }
  }
  return cloud;
}

}  // namespace fleetmap::sim
