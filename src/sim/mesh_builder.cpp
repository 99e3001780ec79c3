#include "mesh_builder.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace fleetmap::sim {

std::uint32_t MeshBuilder::vertex(const Point& p) {
  const Point enu(direction_.x() * p.x() - direction_.y() * p.y(),
                  direction_.y() * p.x() + direction_.x() * p.y(), p.z());
  mesh_.vertices.emplace_back(enu.cast<float>());
  return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
}

void MeshBuilder::triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, Material material) {
  mesh_.triangles.push_back({a, b, c});
  mesh_.materials.push_back(material);
}

void MeshBuilder::triangle(const Point& a, const Point& b, const Point& c, Material material) {
  const std::uint32_t first = vertex(a);
  vertex(b);
  vertex(c);
  triangle(first, first + 1, first + 2, material);
}

void MeshBuilder::quad(const Point& a, const Point& b, const Point& c, const Point& d, Material material) {
  const std::uint32_t first = vertex(a);
  vertex(b);
  vertex(c);
  vertex(d);
  triangle(first, first + 1, first + 2, material);
  triangle(first, first + 2, first + 3, material);
}

void MeshBuilder::slab(const std::array<Point, 4>& corners, const Point& height, Material material) {
  const auto base = static_cast<std::uint32_t>(mesh_.vertices.size());
  for (const Point& corner : corners) vertex(corner);
  for (const Point& corner : corners) vertex(corner + height);
  triangle(base, base + 2, base + 1, material);
  triangle(base, base + 3, base + 2, material);
  triangle(base + 4, base + 5, base + 6, material);
  triangle(base + 4, base + 6, base + 7, material);
  for (std::uint32_t k = 0; k < 4; ++k) {
    const std::uint32_t next = (k + 1) % 4;
    triangle(base + k, base + next, base + 4 + next, material);
    triangle(base + k, base + 4 + next, base + 4 + k, material);
  }
}

void MeshBuilder::post(const Point& foot, double height, double radius, int sides, Material material) {
  const auto base = static_cast<std::uint32_t>(mesh_.vertices.size());
  const auto count = static_cast<std::uint32_t>(sides);
  for (int k = 0; k < sides; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / sides;
    const Point rim = foot + radius * Point(std::cos(angle), std::sin(angle), 0.0);
    vertex(rim);
    vertex(rim + Point(0.0, 0.0, height));
  }
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint32_t a = base + 2 * k, b = base + 2 * ((k + 1) % count);
    triangle(a, b, b + 1, material);
    triangle(a, b + 1, a + 1, material);
  }
}

void MeshBuilder::beam(const Point& from, const Point& to, double width, Material material) {
  const Point along = (to - from).normalized();
  const Point side = along.cross(std::abs(along.z()) < 0.9 ? Point::UnitZ() : Point::UnitX()).normalized();
  const Point up = side.cross(along);
  const std::array<Point, 4> corners = {-side - up, side - up, side + up, up - side};
  for (std::size_t k = 0; k < 4; ++k) {
    const Point a = 0.5 * width * corners[k], b = 0.5 * width * corners[(k + 1) % 4];
    quad(from + a, to + a, to + b, from + b, material);
  }
}

}  // namespace fleetmap::sim
