#pragma once

#include <Eigen/Core>
#include <array>

#include "fleetmap/sim/mesh.hpp"

namespace fleetmap::sim {

/// Adds simple bodies to a mesh, in metres of the frame (u, v, z) that `direction` turns into ENU.
class MeshBuilder {
 public:
  using Point = Eigen::Vector3d;

  /// `direction`: unit vector (ENU) of the frame's u axis.
  MeshBuilder(Mesh& mesh, const Eigen::Vector2d& direction) : mesh_(mesh), direction_(direction) {}

  std::uint32_t vertex(const Point& p);
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, Material material);
  void triangle(const Point& a, const Point& b, const Point& c, Material material);
  void quad(const Point& a, const Point& b, const Point& c, const Point& d, Material material);
  /// Six faces between four corners and the same shifted by `height`.
  void slab(const std::array<Point, 4>& corners, const Point& height, Material material);
  /// An upright tube of `sides` faces, open at both ends.
  void post(const Point& foot, double height, double radius, int sides, Material material);
  /// A square beam between two points, open at both ends.
  void beam(const Point& from, const Point& to, double width, Material material);

 private:
  Mesh& mesh_;
  Eigen::Vector2d direction_;
};

}  // namespace fleetmap::sim
