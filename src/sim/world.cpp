#include "fleetmap/sim/world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>

#include "ground_raster.hpp"

namespace fleetmap::sim {
namespace {

constexpr double kMaxCells = 64e6;
constexpr double kMinShare = 0.02;     // of the cells, drivable
constexpr double kMinArea = 4.0;       // m^2, drivable
constexpr double kNormalReach = 0.25;  // m: half of a small robot's length

std::string text(double value) {
  std::ostringstream out;
  out.precision(4);
  out << value;
  return out.str();
}

Status consistent(const Mesh& mesh) {
  if (mesh.empty()) return failure("the mesh has no triangles; give one of the ground and what stands on it");
  if (mesh.materials.size() != mesh.triangles.size())
    return failure("the mesh has " + std::to_string(mesh.triangles.size()) + " triangles but " +
                   std::to_string(mesh.materials.size()) + " materials; give one a triangle");
  for (std::size_t k = 0; k < mesh.vertices.size(); ++k) {
    if (!mesh.vertices[k].allFinite())
      return failure("vertex " + std::to_string(k) + " of the mesh is not finite; repair the mesh");
  }
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
    for (const std::uint32_t index : mesh.triangles[k]) {
      if (index >= mesh.vertices.size())
        return failure("triangle " + std::to_string(k) + " of the mesh names vertex " +
                       std::to_string(index) + " of " + std::to_string(mesh.vertices.size()) +
                       "; repair the mesh");
    }
  }
  return {};
}

/// Bounds of the vertices that triangles use: stray ones do not extend the world.
WorldBounds bounds_of(const Mesh& mesh) {
  WorldBounds bounds;
  bounds.low.setConstant(std::numeric_limits<double>::infinity());
  bounds.high = -bounds.low;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t index : triangle) {
      const Eigen::Vector2d p = mesh.vertices[index].head<2>().cast<double>();
      bounds.low = bounds.low.cwiseMin(p);
      bounds.high = bounds.high.cwiseMax(p);
    }
  }
  return bounds;
}

std::string spans(const WorldBounds& bounds) {
  const Eigen::Vector2d size = bounds.high - bounds.low;
  return "the mesh spans " + text(size.x()) + " m east by " + text(size.y()) + " m north";
}

Result<Grid> grid_over(const WorldBounds& bounds, double cell) {
  const Eigen::Vector2d cells = ((bounds.high - bounds.low) / cell).array().ceil().max(1.0);
  if (cells.x() * cells.y() > kMaxCells)
    return failure(spans(bounds) + ", more than " + text(kMaxCells) + " cells of " + text(cell) +
                   " m; give it in metres, cut it, or use a larger drivable.cell");
  return Grid{bounds.low, cell, static_cast<int>(cells.x()), static_cast<int>(cells.y())};
}

Status drivable_enough(const WorldBounds& bounds, double share, std::size_t free_cells, double cell) {
  const double free_area = static_cast<double>(free_cells) * cell * cell;
  if (share >= kMinShare && free_area >= kMinArea) return {};
  return failure("this world cannot be driven: " + spans(bounds) + ", but only " + text(free_area) +
                 " m^2 (" + text(100.0 * share) +
                 " %) of it is free and flat enough; give the mesh in metres with z up and with the ground, "
                 "or raise drivable.max_slope_deg or drivable.step_height");
}

}  // namespace

Result<std::shared_ptr<const World>> World::create(Mesh mesh, const DrivableConfig& config,
                                                   SiteDrawing drawing) {
  if (const Status valid = config.validate(); !valid) return tl::unexpected(valid.error());
  if (const Status valid = consistent(mesh); !valid) return tl::unexpected(valid.error());
  const WorldBounds bounds = bounds_of(mesh);
  const Result<Grid> grid = grid_over(bounds, config.cell);
  if (!grid) return tl::unexpected(grid.error());
  GroundRaster ground = ground_raster(mesh, *grid, config.step_height);
  std::vector<std::uint8_t> blocked = obstacle_raster(mesh, *grid, ground, config);

  const auto free_cells = static_cast<std::size_t>(std::ranges::count(blocked, std::uint8_t{0}));
  const double share = static_cast<double>(free_cells) / static_cast<double>(grid->size());
  if (const Status enough = drivable_enough(bounds, share, free_cells, config.cell); !enough)
    return tl::unexpected(enough.error());

  auto world = std::shared_ptr<World>(new World());
  world->mesh_ = std::move(mesh);
  world->bounds_ = bounds;
  world->drawing_ = std::move(drawing);
  if (world->drawing_.boundary.empty()) {
    world->drawing_.boundary = {
        bounds.low, {bounds.high.x(), bounds.low.y()}, bounds.high, {bounds.low.x(), bounds.high.y()}};
  }
  world->config_ = config;
  world->size_ = {grid->columns, grid->rows};
  world->heights_ = std::move(ground.heights);
  world->blocked_ = std::move(blocked);
  world->drivable_share_ = share;
  return world;
}

double World::ground_height(const Eigen::Vector2d& p) const {
  const Eigen::Vector2d last = (size_ - Eigen::Vector2i::Ones()).cast<double>();
  const Eigen::Vector2d cells = (p - bounds_.low) / config_.cell - Eigen::Vector2d::Constant(0.5);
  if (!cells.allFinite()) return 0.0;
  const Eigen::Vector2d at = cells.cwiseMax(0.0).cwiseMin(last);
  const Eigen::Vector2i corner = at.cast<int>();
  const Eigen::Vector2i next = (corner + Eigen::Vector2i::Ones()).cwiseMin(size_ - Eigen::Vector2i::Ones());
  const Eigen::Vector2d share = at - corner.cast<double>();
  const auto height = [&](int column, int row) {
    return static_cast<double>(heights_[static_cast<std::size_t>(row) * static_cast<std::size_t>(size_.x()) +
                                        static_cast<std::size_t>(column)]);
  };
  const double south = std::lerp(height(corner.x(), corner.y()), height(next.x(), corner.y()), share.x());
  const double north = std::lerp(height(corner.x(), next.y()), height(next.x(), next.y()), share.x());
  return std::lerp(south, north, share.y());
}

Eigen::Vector3d World::ground_normal(const Eigen::Vector2d& p) const {
  const double reach = std::max(kNormalReach, config_.cell);
  const Eigen::Vector2d east(reach, 0.0), north(0.0, reach);
  const double slope_x = (ground_height(p + east) - ground_height(p - east)) / (2.0 * reach);
  const double slope_y = (ground_height(p + north) - ground_height(p - north)) / (2.0 * reach);
  return Eigen::Vector3d(-slope_x, -slope_y, 1.0).normalized();
}

bool World::blocked(const Eigen::Vector2d& p, double radius) const {
  if (!bounds_.contains(p)) return true;
  return clearance(p, std::max(radius, 1e-9)) < std::max(radius, 1e-9);
}

double World::clearance(const Eigen::Vector2d& p, double limit) const {
  if (!bounds_.contains(p) || !(limit > 0.0)) return 0.0;
  const Eigen::Vector2d at = (p - bounds_.low) / config_.cell;  // in cells
  const Eigen::Vector2i home =
      at.cast<int>().cwiseMin(size_ - Eigen::Vector2i::Ones()).cwiseMax(Eigen::Vector2i::Zero());
  double nearest = limit / config_.cell;
  const auto visit = [&](int column, int row) {
    if (column < 0 || row < 0 || column >= size_.x() || row >= size_.y()) return;
    if (blocked_[static_cast<std::size_t>(row) * static_cast<std::size_t>(size_.x()) +
                 static_cast<std::size_t>(column)] == 0)
      return;
    const Eigen::Vector2d corner(column, row);
    const Eigen::Vector2d closest = at.cwiseMax(corner).cwiseMin(corner + Eigen::Vector2d::Ones());
    nearest = std::min(nearest, (at - closest).norm());
  };
  const int rings = std::max(size_.x(), size_.y());
  // A cell of ring k is at least k - 1 cells away.
  for (int ring = 0; ring <= rings && static_cast<double>(ring - 1) < nearest; ++ring) {
    const Eigen::Vector2i low = home - Eigen::Vector2i::Constant(ring);
    const Eigen::Vector2i high = home + Eigen::Vector2i::Constant(ring);
    for (int column = low.x(); column <= high.x(); ++column) {
      visit(column, low.y());
      if (ring > 0) visit(column, high.y());
    }
    for (int row = low.y() + 1; row < high.y(); ++row) {
      visit(low.x(), row);
      visit(high.x(), row);
    }
  }
  return nearest * config_.cell;
}

}  // namespace fleetmap::sim
