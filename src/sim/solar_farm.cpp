#include "fleetmap/sim/solar_farm.hpp"

#include <cmath>
#include <sstream>

#include "solar_farm_layout.hpp"
#include "solar_farm_parts.hpp"

namespace fleetmap::sim {
namespace {

constexpr double kRobotRadius = 0.35;  // m, that every lane must let pass

Mesh mesh_of(const SolarFarmConfig& config, const SolarFarmLayout& layout) {
  Mesh mesh;
  MeshBuilder builder(mesh, layout.direction);
  const FarmGround ground{layout, Terrain(config.terrain, config.seed)};
  add_ground(config, ground, builder);
  for (std::size_t row = 0; row < layout.rows.size(); ++row) {
    for (std::size_t place = 0; place < layout.tables.size(); ++place) {
      if (layout.places[row][place] == TableSlot::kTable) add_table(config, ground, row, place, builder);
      if (layout.places[row][place] == TableSlot::kCabin) add_cabin(config, ground, row, place, builder);
    }
  }
  if (config.fence.enabled) add_fence(config, ground, builder);
  for (std::size_t tree = 0; tree < layout.trees.size(); ++tree) add_tree(config, ground, tree, builder);
  return mesh;
}

Status lanes_are_free(const World& world) {
  for (std::size_t k = 0; k < world.aisles().size(); ++k) {
    const Aisle& aisle = world.aisles()[k];
    const int steps = static_cast<int>(std::ceil((aisle.to - aisle.from).norm() / 0.25));
    for (int step = 0; step <= steps; ++step) {
      const Eigen::Vector2d p = aisle.from + (aisle.to - aisle.from) * (static_cast<double>(step) / steps);
      if (!world.blocked(p, kRobotRadius)) continue;
      std::ostringstream out;
      out.precision(4);
      out << "this world cannot be driven: lane " << k + 1 << " of " << world.aisles().size()
          << " is blocked at east " << p.x() << " m, north " << p.y()
          << " m; lower terrain.rolling_amplitude or terrain.rough_amplitude, or raise "
             "drivable.max_slope_deg or drivable.step_height";
      return failure(out.str());
    }
  }
  return {};
}

}  // namespace

Result<std::shared_ptr<const World>> make_solar_farm(const SolarFarmConfig& config) {
  if (const Status valid = config.validate(); !valid) return tl::unexpected(valid.error());
  const SolarFarmLayout layout = lay_out(config);
  auto world = World::create(mesh_of(config, layout), config.drivable, drawing_of(config, layout));
  if (!world) return world;
  if (const Status free = lanes_are_free(**world); !free) return tl::unexpected(free.error());
  return world;
}

}  // namespace fleetmap::sim
