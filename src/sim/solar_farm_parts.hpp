#pragma once

#include "fleetmap/sim/solar_farm.hpp"
#include "fleetmap/sim/terrain.hpp"
#include "mesh_builder.hpp"
#include "solar_farm_layout.hpp"

namespace fleetmap::sim {

/// Height of the ground (m) in the farm's own frame.
struct FarmGround {
  const SolarFarmLayout& layout;
  Terrain terrain;
  double height(double u, double v) const {
    const Eigen::Vector2d p = layout.enu({u, v});
    return terrain.height(p.x(), p.y());
  }
};

void add_ground(const SolarFarmConfig& config, const FarmGround& ground, MeshBuilder& builder);
void add_table(const SolarFarmConfig& config, const FarmGround& ground, std::size_t row, std::size_t place,
               MeshBuilder& builder);
void add_cabin(const SolarFarmConfig& config, const FarmGround& ground, std::size_t row, std::size_t place,
               MeshBuilder& builder);
void add_fence(const SolarFarmConfig& config, const FarmGround& ground, MeshBuilder& builder);
void add_tree(const SolarFarmConfig& config, const FarmGround& ground, std::size_t tree,
              MeshBuilder& builder);

}  // namespace fleetmap::sim
