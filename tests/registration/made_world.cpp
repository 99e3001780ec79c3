#include "made_world.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <random>

namespace fleetmap::registration::testing {

MadeWorld::MadeWorld(unsigned seed, double half_extent_m) : half_extent_(half_extent_m) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto place = [&] { return (2.0 * unit(random) - 1.0) * half_extent_; };
  const auto area = half_extent_ * half_extent_ * 4.0;
  for (int i = 0; i < static_cast<int>(area / 900.0); ++i) {
    const double angle = M_PI * unit(random), length = 6.0 + 14.0 * unit(random);
    add({place(), place(), 0}, {length * std::cos(angle), length * std::sin(angle), 0},
        {0, 0, 3.0 + 4.0 * unit(random)});
  }
  for (int i = 0; i < static_cast<int>(area / 450.0); ++i) {
    add_box({place(), place(), 0},
            {1.0 + 3.0 * unit(random), 1.0 + 3.0 * unit(random), 0.8 + 2.0 * unit(random)},
            M_PI * unit(random));
  }
  for (int i = 0; i < static_cast<int>(area / 300.0); ++i) {
    add_box({place(), place(), 0}, {0.25, 0.25, 3.0 + 3.0 * unit(random)}, M_PI * unit(random));
  }
}

MadeWorld MadeWorld::corridor() {
  MadeWorld world;
  world.add({-200, -4, 0}, {400, 0, 0}, {0, 0, 5});
  world.add({-200, 5, 0}, {400, 0, 0}, {0, 0, 5});
  world.with_ground_ = true;
  world.half_extent_ = 200.0;
  return world;
}

cloud::PointCloud MadeWorld::scan(const Pose& T_world_sensor, std::size_t count, double noise_m,
                                  unsigned seed, double radius_m) const {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::normal_distribution<double> gauss(0.0, noise_m);
  std::vector<double> areas;
  for (const auto& s : surfaces_) areas.push_back(s.a.cross(s.b).norm());
  std::discrete_distribution<std::size_t> pick(areas.begin(), areas.end());
  const Pose T_sensor_world = T_world_sensor.inverse();
  cloud::PointCloud cloud;
  while (cloud.size() < count) {
    Eigen::Vector3d p;
    if (with_ground_ && unit(random) < 0.2) {
      const double r = radius_m * std::sqrt(unit(random)), angle = 2.0 * M_PI * unit(random);
      p = T_world_sensor.translation() + Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), 0);
      p.z() = 0.0;
    } else {
      const auto& s = surfaces_[pick(random)];
      p = s.corner + unit(random) * s.a + unit(random) * s.b;
    }
    const Eigen::Vector3d q = T_sensor_world * p;
    if (q.norm() > radius_m) continue;
    cloud.points.emplace_back(
        (q + Eigen::Vector3d(gauss(random), gauss(random), gauss(random))).cast<float>());
  }
  return cloud;
}

void MadeWorld::add(const Eigen::Vector3d& corner, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  surfaces_.push_back({corner, a, b});
}

void MadeWorld::add_box(const Eigen::Vector3d& corner, const Eigen::Vector3d& size, double angle) {
  const Eigen::Vector3d a = size.x() * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
  const Eigen::Vector3d b = size.y() * Eigen::Vector3d(-std::sin(angle), std::cos(angle), 0);
  const Eigen::Vector3d c(0, 0, size.z());
  add(corner, a, c);
  add(corner, b, c);
  add(corner + a, b, c);
  add(corner + b, a, c);
  add(corner + c, a, b);
}

ScanPair scan_pair(const MadeWorld& world, double apart_m, double yaw, unsigned seed, std::size_t count) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const double bearing = M_PI * unit(random);
  const Pose T_world_target =
      make_pose(rotation_from_rpy(0.05 * unit(random), 0.05 * unit(random), M_PI * unit(random)),
                Eigen::Vector3d(5 * unit(random), 5 * unit(random), 1.2));
  const Pose T_target_source = make_pose(
      rotation_from_rpy(0.08 * unit(random), 0.08 * unit(random), yaw),
      Eigen::Vector3d(apart_m * std::cos(bearing), apart_m * std::sin(bearing), 0.3 * unit(random)));
  return {world.scan(T_world_target, count, 0.03, seed + 1000),
          world.scan(T_world_target * T_target_source, count, 0.03, seed + 2000), T_target_source};
}

PoseError error_between(const Pose& truth, const Pose& estimate) {
  const Pose d = truth.inverse() * estimate;
  return {d.translation().norm(), so3_log(d.linear()).norm()};
}

}  // namespace fleetmap::registration::testing
