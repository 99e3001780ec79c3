#pragma once

#include <memory>

#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/sim/robot_twin_config.hpp"
#include "fleetmap/sim/world.hpp"

namespace fleetmap::apps {

inline const GeoPoint kFlatSiteOrigin = geo_point_from_degrees(39.0, -3.0, 600.0);

/// Flat ground of 80 m x 80 m around the origin.
inline std::shared_ptr<const sim::World> flat_site() {
  sim::Mesh mesh;
  mesh.vertices = {{-40, -40, 0}, {40, -40, 0}, {40, 40, 0}, {-40, 40, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.materials = {sim::Material::kGround, sim::Material::kGround};
  return sim::World::create(mesh, {}, {}).value();
}

/// A robot with a LiDAR of few rays.
inline sim::RobotTwinConfig flat_site_robot() {
  sim::RobotTwinConfig config;
  config.lidar = sim::vlp16_spec();
  config.lidar.columns = 180;
  config.T_base_lidar.translation() = Eigen::Vector3d(0.0, 0.0, 0.6);
  config.has_start = true;
  return config;
}

}  // namespace fleetmap::apps
