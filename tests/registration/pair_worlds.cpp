#include "pair_worlds.hpp"

#include <Eigen/Geometry>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "fleetmap/cloud/voxel_grid.hpp"
#include "fleetmap/sim/lidar.hpp"
#include "fleetmap/sim/robot_twin.hpp"
#include "fleetmap/sim/terrain.hpp"

namespace fleetmap::registration::testing {
namespace {

using sim::Mesh;

constexpr double kBaseHeight = 0.1;  // m

Pose pose_on_ground(const Site& site, const Eigen::Vector2d& p, double yaw, double height) {
  const double e = 0.3;
  const Eigen::Vector3d normal =
      Eigen::Vector3d(site.ground({p.x() - e, p.y()}) - site.ground({p.x() + e, p.y()}),
                      site.ground({p.x(), p.y() - e}) - site.ground({p.x(), p.y() + e}), 2 * e)
          .normalized();
  const Eigen::Matrix3d tilt =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), normal).toRotationMatrix();
  return make_pose(tilt * rotation_from_rpy(0, 0, yaw),
                   Eigen::Vector3d(p.x(), p.y(), site.ground(p)) + height * normal);
}

/// The surface of a wood: ground, trees and boulders as single triangles.
class WildMesh {
 public:
  WildMesh(std::shared_ptr<const sim::Terrain> terrain, double reach, unsigned seed)
      : terrain_(std::move(terrain)), reach_(reach), random_(seed) {}

  void add_ground() {
    for (double x = -reach_; x < reach_; x += 1.0) {
      for (double y = -reach_; y < reach_; y += 1.0) {
        triangle(at(x, y), at(x + 1, y), at(x + 1, y + 1), sim::Material::kGround);
        triangle(at(x, y), at(x + 1, y + 1), at(x, y + 1), sim::Material::kGround);
      }
    }
  }
  /// One in 150 m², of which some are boulders.
  void add_trees() {
    const int trees = static_cast<int>(4.0 * reach_ * reach_ / 150.0);
    for (int k = 0; k < trees; ++k) {
      const Eigen::Vector3d foot =
          at(reach_ * (2 * unit() - 1), reach_ * (2 * unit() - 1)) - Eigen::Vector3d(0, 0, 0.2);
      if (unit() < 0.15) {
        prism(foot, 0.5 + 1.5 * unit(), 0.6 + 1.2 * unit(), sim::Material::kConcrete);
        continue;
      }
      const double trunk = 2.0 + 2.0 * unit(), crown = 1.0 + 1.5 * unit();
      prism(foot, 0.1 + 0.15 * unit(), trunk + 0.5, sim::Material::kVegetation);
      add_leaves(foot + Eigen::Vector3d(0, 0, trunk + crown), crown);
    }
  }
  const Mesh& mesh() const { return mesh_; }

 private:
  double unit() { return unit_(random_); }
  Eigen::Vector3d at(double x, double y) const { return {x, y, terrain_->height(x, y)}; }

  void triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                sim::Material material) {
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    for (const auto& p : {a, b, c}) mesh_.vertices.push_back(p.cast<float>());
    mesh_.triangles.push_back({first, first + 1, first + 2});
    mesh_.materials.push_back(material);
  }
  void prism(const Eigen::Vector3d& foot, double radius, double height, sim::Material material) {
    for (int k = 0; k < 6; ++k) {
      const auto rim = [&](int i) {
        const double angle = i * std::numbers::pi / 3.0;
        return Eigen::Vector3d(foot + radius * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0));
      };
      const Eigen::Vector3d up(0, 0, height);
      triangle(rim(k), rim(k + 1), rim(k + 1) + up, material);
      triangle(rim(k), rim(k + 1) + up, rim(k) + up, material);
      triangle(foot + up, rim(k) + up, rim(k + 1) + up, material);
    }
  }
  void add_leaves(const Eigen::Vector3d& middle, double crown) {
    for (int leaf = 0; leaf < 150; ++leaf) {
      Eigen::Vector3d d(2 * unit() - 1, 2 * unit() - 1, 2 * unit() - 1);
      if (d.norm() > 1.0) continue;
      const Eigen::Vector3d p = middle + crown * d;
      const auto edge = [&] {
        return Eigen::Vector3d(0.3 * (2 * unit() - 1), 0.3 * (2 * unit() - 1), 0.3 * (2 * unit() - 1));
      };
      triangle(p, p + edge(), p + edge(), sim::Material::kVegetation);
    }
  }

  std::shared_ptr<const sim::Terrain> terrain_;
  double reach_;
  std::mt19937_64 random_;
  std::uniform_real_distribution<double> unit_{0.0, 1.0};
  Mesh mesh_;
};

}  // namespace

Site farm_site(const std::string& name, const sim::SolarFarmConfig& config) {
  const auto world = sim::make_solar_farm(config).value();
  return {name, sim::Scene::create(world->mesh()).value(),
          [world](const Eigen::Vector2d& p) { return world->ground_height(p); }, world->aisles()};
}

Site wild_site(const std::string& name, unsigned seed, double half_m) {
  sim::TerrainConfig shape;
  shape.rolling_amplitude = 1.0;
  shape.rolling_wavelength = 60.0;
  shape.rough_amplitude = 0.03;
  const auto terrain = std::make_shared<sim::Terrain>(shape, seed);
  WildMesh wood(terrain, half_m + 60.0, seed);
  wood.add_ground();
  wood.add_trees();
  Site site{name,
            sim::Scene::create(wood.mesh()).value(),
            [terrain](const Eigen::Vector2d& p) { return terrain->height(p.x(), p.y()); },
            {}};
  for (double y = -half_m; y <= half_m; y += 9.0) site.lanes.push_back({{-half_m, y}, {half_m, y}});
  return site;
}

MappedNode map_node(const Site& site, const sim::Aisle& lane, double along, double aside, bool backwards,
                    const Gathering& how, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> gauss;
  const Eigen::Vector2d ahead = (lane.to - lane.from).normalized();
  const Eigen::Vector2d left(-ahead.y(), ahead.x());
  const double length = (lane.to - lane.from).norm();
  const double yaw = std::atan2(ahead.y(), ahead.x()) + (backwards ? std::numbers::pi : 0.0);
  const auto pose_at = [&](double s) {
    const double wobble = aside + 0.15 * std::sin(0.4 * s + static_cast<double>(seed % 100));
    return pose_on_ground(site, lane.from + s * ahead + wobble * left,
                          yaw + 0.06 * std::cos(0.4 * s + static_cast<double>(seed % 100)), kBaseHeight);
  };
  sim::LidarSpec lidar = sim::vlp16_spec();
  lidar.range_noise = how.range_noise_m;
  lidar.max_range = how.max_range_m;
  lidar.columns = 900;
  const Pose T_base_lidar = make_pose(Eigen::Matrix3d::Identity(), Eigen::Vector3d(0, 0, 0.35));
  MappedNode node;
  node.T_enu_node = pose_at(along);
  cloud::VoxelMerger merger(static_cast<float>(how.submap_voxel_m));
  const auto scan_at = [&](double s, const Pose& T_node_base_estimate) {
    sim::ScanJob job;
    job.step = std::chrono::milliseconds(200);
    job.number = static_cast<std::uint64_t>(random() & 0xffffffffu);
    job.seed = seed;
    job.T_enu_lidar.assign(2, pose_at(s) * T_base_lidar);
    cloud::PointCloud points;
    for (const auto& point : sim::cast_scan(*site.scene, lidar, job).points)
      points.points.push_back(point.position);
    merger.add(transformed(points, T_node_base_estimate * T_base_lidar));
  };
  scan_at(along, Pose::Identity());
  for (const double direction : {-1.0, 1.0}) {
    Pose T_node_base = Pose::Identity();
    Pose before = node.T_enu_node;
    for (double d = how.scan_spacing_m; d <= how.reach_m; d += how.scan_spacing_m) {
      const double s = along + direction * d;
      if (s < -2.0 || s > length + 2.0) break;
      const Pose now = pose_at(s);
      Vector6d error;
      for (int k = 0; k < 6; ++k)
        error[k] = std::sqrt(how.scan_spacing_m) * (k < 3 ? how.drift_m : how.drift_rad) * gauss(random);
      T_node_base = T_node_base * before.inverse() * now * se3_exp(error);
      before = now;
      scan_at(s, T_node_base);
    }
  }
  node.map = merger.cloud();
  return node;
}

Prior drawn_prior(const Pose& T_enu_target, const Pose& T_enu_source, double sigma_m, double sigma_yaw,
                  double sigma_tilt, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> gauss;
  const auto believed = [&](const Pose& T_enu_node) {
    const double half = std::sqrt(0.5);
    const Eigen::Vector3d turn(half * sigma_tilt * gauss(random), half * sigma_tilt * gauss(random),
                               half * sigma_yaw * gauss(random));
    Pose T = T_enu_node;
    T.linear() = so3_exp(turn) * T.linear();
    for (int k = 0; k < 3; ++k) T.translation()[k] += half * sigma_m * (k == 2 ? 2.0 : 1.0) * gauss(random);
    return T;
  };
  const Pose target = believed(T_enu_target), source = believed(T_enu_source);
  Prior prior;
  prior.T_target_source = target.inverse() * source;
  const double swing = std::sqrt(0.5) * sigma_yaw * prior.T_target_source.translation().norm();
  prior.sigma_translation_m = std::hypot(sigma_m, swing);
  prior.sigma_height_m = std::hypot(2.0 * sigma_m, sigma_tilt * prior.T_target_source.translation().norm());
  prior.sigma_yaw_rad = sigma_yaw;
  prior.sigma_tilt_rad = sigma_tilt;
  prior.up_target = target.linear().transpose() * Eigen::Vector3d::UnitZ();
  return prior;
}

}  // namespace fleetmap::registration::testing
