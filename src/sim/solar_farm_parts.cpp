#include "solar_farm_parts.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "counter_random.hpp"

namespace fleetmap::sim {
namespace {

using Point = MeshBuilder::Point;

constexpr std::uint64_t kTableTilt = 0xB1, kTableHeight = 0xB2, kLeaf = 0xB3, kTreeSize = 0xB4;
constexpr double kSunk = 0.3;  // m that posts and walls reach into the ground
constexpr int kPostSides = 6;

/// A table's plane: heights along its two long edges.
struct TablePlane {
  Point middle;  ///< of the glass's lower face
  Point along;   ///< unit, up the row
  Point across;  ///< unit, up the slope
};

/// The straight line that the ground at the table's posts follows best, raised to the table's height.
TablePlane table_plane(const SolarFarmConfig& config, const FarmGround& ground, std::size_t row,
                       std::size_t place) {
  const double u = ground.layout.tables[place], v = ground.layout.rows[row];
  const double tilt =
      config.tilt_rad + config.tilt_jitter_rad * signed_at(config.seed, kTableTilt, row, place);
  const double half = 0.5 * config.table_length;
  constexpr int kSamples = 5;
  double mean = 0.0, slope = 0.0, squares = 0.0;
  for (int k = 0; k < kSamples; ++k) {
    const double offset = half * (2.0 * k / (kSamples - 1) - 1.0);
    const double height = ground.height(u + offset, v);
    mean += height / kSamples;
    slope += offset * height;
    squares += offset * offset;
  }
  const double raise = config.lower_edge_height + 0.5 * config.table_width * std::sin(tilt) +
                       config.height_jitter * signed_at(config.seed, kTableHeight, row, place);
  const Point along = Point(1.0, 0.0, slope / squares).normalized();
  const Point level_across(0.0, std::cos(tilt), std::sin(tilt));
  const Point across = (level_across - along * along.dot(level_across)).normalized();
  return {Point(u, v, mean + raise), along, across};
}

void add_post_under(const Point& top, const SolarFarmConfig& config, const FarmGround& ground,
                    MeshBuilder& builder) {
  const double foot = ground.height(top.x(), top.y()) - kSunk;
  if (top.z() <= foot) return;
  builder.post({top.x(), top.y(), foot}, top.z() - foot, config.post_radius, kPostSides, Material::kMetal);
}

/// One panel of the fence: two rails and upright wires between two posts.
void add_fence_panel(const FenceConfig& fence, const Point& from, const Point& to, MeshBuilder& builder) {
  const Point up = Point::UnitZ();
  for (const double height : {0.15, fence.height - 0.05})
    builder.beam(from + height * up, to + height * up, 0.04, Material::kMetal);
  if (fence.wire_spacing <= 0.0) return;
  const Point span = to - from;
  const double length = span.head<2>().norm();
  const Point half_wire = 0.5 * fence.wire_width / length * span;
  const int wires = static_cast<int>(std::floor(length / fence.wire_spacing));
  for (int k = 1; k < wires; ++k) {
    const Point at = from + span * (static_cast<double>(k) / wires);
    builder.quad(at - half_wire + 0.1 * up, at + half_wire + 0.1 * up, at + half_wire + fence.height * up,
                 at - half_wire + fence.height * up, Material::kMetal);
  }
}

}  // namespace

void add_ground(const SolarFarmConfig& config, const FarmGround& ground, MeshBuilder& builder) {
  const Eigen::Vector2d half = ground.layout.half_site + Eigen::Vector2d::Constant(config.margin);
  const Eigen::Vector2i cells = (2.0 * half / config.terrain_cell).array().ceil().cast<int>();
  const auto columns = static_cast<std::uint32_t>(cells.x() + 1);
  std::uint32_t first = 0;
  for (int row = 0; row <= cells.y(); ++row) {
    for (int column = 0; column <= cells.x(); ++column) {
      const double u = half.x() * (2.0 * column / cells.x() - 1.0);
      const double v = half.y() * (2.0 * row / cells.y() - 1.0);
      const std::uint32_t index = builder.vertex({u, v, ground.height(u, v)});
      if (row == 0 && column == 0) first = index;
    }
  }
  for (std::uint32_t row = 0; row < static_cast<std::uint32_t>(cells.y()); ++row) {
    for (std::uint32_t column = 0; column + 1 < columns; ++column) {
      const std::uint32_t a = first + row * columns + column, b = a + columns;
      builder.triangle(a, a + 1, b + 1, Material::kGround);
      builder.triangle(a, b + 1, b, Material::kGround);
    }
  }
}

void add_table(const SolarFarmConfig& config, const FarmGround& ground, std::size_t row, std::size_t place,
               MeshBuilder& builder) {
  const TablePlane plane = table_plane(config, ground, row, place);
  const Point u = 0.5 * config.table_length * plane.along, v = 0.5 * config.table_width * plane.across;
  const Point up = plane.along.cross(plane.across) * config.table_thickness;
  const Point& m = plane.middle;
  builder.slab({m - u - v, m + u - v, m + u + v, m - u + v}, up, Material::kGlass);

  // Steel below the glass: a beam along the table, and at each pair of posts one up the slope.
  constexpr double kBeam = 0.08;
  const Point below = -plane.along.cross(plane.across) * (0.5 * kBeam + 0.005);
  builder.beam(m - 0.98 * u + below, m + 0.98 * u + below, kBeam, Material::kMetal);
  const int stations = std::max(2, static_cast<int>(std::lround(config.table_length / config.post_spacing)));
  for (int k = 0; k < stations; ++k) {
    const Point station = m + below + u * (2.0 * (k + 0.5) / stations - 1.0);
    builder.beam(station - 0.95 * v, station + 0.95 * v, kBeam, Material::kMetal);
    for (const double share : {-0.6, 0.6}) add_post_under(station + share * v, config, ground, builder);
  }
}

void add_cabin(const SolarFarmConfig& config, const FarmGround& ground, std::size_t row, std::size_t place,
               MeshBuilder& builder) {
  const Eigen::Vector2d half = 0.5 * cabin_size(config);
  const double u = ground.layout.tables[place], v = ground.layout.rows[row];
  const double floor = ground.height(u, v);
  constexpr double kCabinHeight = 2.8;
  const std::array<Point, 4> corners = {
      Point(u - half.x(), v - half.y(), floor - kSunk), Point(u + half.x(), v - half.y(), floor - kSunk),
      Point(u + half.x(), v + half.y(), floor - kSunk), Point(u - half.x(), v + half.y(), floor - kSunk)};
  // Walls and a roof; a floor would be taken for the ground.
  const Point up(0.0, 0.0, kCabinHeight + kSunk);
  for (std::size_t k = 0; k < 4; ++k) {
    const Point &a = corners[k], &b = corners[(k + 1) % 4];
    builder.quad(a, b, b + up, a + up, Material::kConcrete);
  }
  builder.quad(corners[0] + up, corners[1] + up, corners[2] + up, corners[3] + up, Material::kConcrete);
}

void add_fence(const SolarFarmConfig& config, const FarmGround& ground, MeshBuilder& builder) {
  const Eigen::Vector2d& half = ground.layout.half_site;
  const std::array<Eigen::Vector2d, 4> corners = {Eigen::Vector2d(-half.x(), -half.y()),
                                                  Eigen::Vector2d(half.x(), -half.y()), half,
                                                  Eigen::Vector2d(-half.x(), half.y())};
  const auto on_ground = [&](const Eigen::Vector2d& p) {
    return Point(p.x(), p.y(), ground.height(p.x(), p.y()));
  };
  for (std::size_t side = 0; side < 4; ++side) {
    const Eigen::Vector2d from = corners[side], to = corners[(side + 1) % 4];
    const int panels =
        std::max(1, static_cast<int>(std::lround((to - from).norm() / config.fence.post_spacing)));
    for (int k = 0; k < panels; ++k) {
      const Point a = on_ground(from + (to - from) * (static_cast<double>(k) / panels));
      const Point b = on_ground(from + (to - from) * (static_cast<double>(k + 1) / panels));
      builder.post(a - Point(0.0, 0.0, kSunk), config.fence.height + kSunk, 0.04, kPostSides,
                   Material::kMetal);
      add_fence_panel(config.fence, a, b, builder);
    }
  }
}

/// A trunk and a cloud of leaves: triangles at random in an ellipsoid, which a beam may pass between.
void add_tree(const SolarFarmConfig& config, const FarmGround& ground, std::size_t tree,
              MeshBuilder& builder) {
  const TreeFootprint& tree_footprint = ground.layout.trees[tree];
  const auto size = [&](std::uint64_t what) { return uniform_at(config.seed, kTreeSize, tree, what); };
  const double trunk = 2.0 + 1.5 * size(0);
  const Point crown_radii(1.2 + 0.8 * size(1), 1.2 + 0.8 * size(2), 1.2 + 1.3 * size(3));
  const Point foot(tree_footprint.center.x(), tree_footprint.center.y(),
                   ground.height(tree_footprint.center.x(), tree_footprint.center.y()));
  builder.post(foot - Point(0.0, 0.0, kSunk), trunk + kSunk + 0.5 * crown_radii.z(), tree_footprint.radius,
               kPostSides, Material::kVegetation);
  const Point crown = foot + Point(0.0, 0.0, trunk + 0.7 * crown_radii.z());
  constexpr std::uint64_t kLeaves = 350;
  for (std::uint64_t leaf = 0; leaf < kLeaves; ++leaf) {
    const auto chance = [&](std::uint64_t what) {
      return uniform_at(config.seed, kLeaf, tree, leaf * 16 + what);
    };
    const auto direction = [&](std::uint64_t what) {
      const double z = 2.0 * chance(what) - 1.0, angle = 2.0 * std::numbers::pi * chance(what + 1);
      const double flat = std::sqrt(1.0 - z * z);
      return Point(flat * std::cos(angle), flat * std::sin(angle), z);
    };
    const Point at = crown + std::cbrt(0.3 + 0.7 * chance(0)) * direction(1).cwiseProduct(crown_radii);
    const double leaf_size = 0.12 + 0.18 * chance(3);
    builder.triangle(at + leaf_size * direction(4), at + leaf_size * direction(6),
                     at + leaf_size * direction(8), Material::kVegetation);
  }
}

}  // namespace fleetmap::sim
