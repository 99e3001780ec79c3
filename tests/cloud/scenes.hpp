#pragma once

#include <cmath>
#include <random>

#include "fleetmap/cloud/point_cloud.hpp"

namespace fleetmap::cloud::testing {

/// A made-up outdoor place with a fixed seed: rolling ground, house fronts, boxes and poles, as points on
/// surfaces within 40 m of the origin, with 2 cm of noise and intensities.
inline PointCloud street_scene(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  std::normal_distribution<float> noise(0.0f, 0.02f);
  PointCloud cloud;
  while (cloud.size() < count) {
    const float u = unit(random), v = unit(random), kind = unit(random);
    Eigen::Vector3f p;
    if (kind < 0.45f) {
      const float range = 38.0f * u, angle = 6.2831853f * v;  // denser near the sensor, like a scan
      p = {range * std::cos(angle), range * std::sin(angle), 0.0f};
      p.z() = 0.3f * std::sin(0.15f * p.x()) + 0.02f * p.y();
    } else if (kind < 0.75f) {
      const float side = unit(random) < 0.5f ? -9.0f : 11.0f;
      p = {70.0f * u - 35.0f, side + (std::fmod(70.0f * u, 14.0f) < 5.0f ? 2.5f : 0.0f), 8.0f * v};
    } else if (kind < 0.9f) {
      const int box = static_cast<int>(random() % 6);
      const Eigen::Vector3f corner(-30.0f + 11.0f * static_cast<float>(box), box % 2 == 0 ? -6.0f : 7.0f,
                                   0.0f);
      const Eigen::Vector3f size(4.0f, 1.8f, 1.5f);
      const int face = static_cast<int>(random() % 3);
      p = corner + Eigen::Vector3f(u * size.x(), v * size.y(), unit(random) * size.z());
      if (face < 2) p[face] = corner[face] + (unit(random) < 0.5f ? 0.0f : size[face]);
      if (face == 2) p.z() = size.z();
    } else {
      const int pole = static_cast<int>(random() % 9);
      p = {-32.0f + 7.3f * static_cast<float>(pole) + 0.1f * std::cos(6.28f * u),
           (pole % 2 == 0 ? -4.0f : 5.0f) + 0.1f * std::sin(6.28f * u), 6.0f * v};
    }
    cloud.points.emplace_back(p.x() + noise(random), p.y() + noise(random), p.z() + noise(random));
    cloud.intensities.push_back(static_cast<float>(random() % 256));
  }
  return cloud;
}

}  // namespace fleetmap::cloud::testing
