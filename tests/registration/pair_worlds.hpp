#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/registration/prior.hpp"
#include "fleetmap/sim/scene.hpp"
#include "fleetmap/sim/solar_farm.hpp"
#include "fleetmap/sim/world.hpp"

namespace fleetmap::registration::testing {

/// A place that robots map, and the lanes that they map it along.
struct Site {
  std::string name;
  std::shared_ptr<const sim::Scene> scene;
  std::function<double(const Eigen::Vector2d&)> ground;
  std::vector<sim::Aisle> lanes;
};

Site farm_site(const std::string& name, const sim::SolarFarmConfig& config);

/// Rolling ground with trees (a trunk, a crown of leaves) and boulders at random.
Site wild_site(const std::string& name, unsigned seed, double half_m = 90.0);

/// Conditions under which a robot gathers the map around a node.
struct Gathering {
  double reach_m = 40.0;        ///< m of lane before and behind the node
  double scan_spacing_m = 1.0;  ///< m
  double range_noise_m = 0.02;  ///< m
  double drift_m = 0.0;         ///< m per root metre, along each axis
  double drift_rad = 0.0;       ///< rad per root metre, about each axis
  double submap_voxel_m = 0.1;  ///< m
  double max_range_m = 60.0;    ///< m
};

/// A node with the map that its robot had around it.
struct MappedNode {
  Pose T_enu_node = Pose::Identity();  ///< the truth
  cloud::PointCloud map;               ///< in the node's frame
};

/// The map of a robot that drove `lane` (from its end if `backwards`), around its node `along` metres from
/// the lane's start and `aside` metres left of it.
MappedNode map_node(const Site& site, const sim::Aisle& lane, double along, double aside, bool backwards,
                    const Gathering& how, unsigned seed);

/// A prior of two robots' relative pose if GPS errs by `sigma_m` (both together, per horizontal axis) and
/// heading and tilt by their sigmas; drawn from exactly these.
Prior drawn_prior(const Pose& T_enu_target, const Pose& T_enu_source, double sigma_m, double sigma_yaw,
                  double sigma_tilt, unsigned seed);

}  // namespace fleetmap::registration::testing
