#include "fleetmap/agent/obstacles.hpp"

#include <cmath>
#include <cstddef>

namespace fleetmap::agent {

std::vector<Eigen::Vector2d> obstacles_among(const std::vector<Eigen::Vector3f>& points_base,
                                             const ObstacleConfig& config) {
  std::vector<Eigen::Vector2d> obstacles;
  const int half = static_cast<int>(std::ceil(config.reach / config.spacing)) + 1;
  std::vector<bool> taken(static_cast<std::size_t>(4 * half * half));
  const float reach2 = static_cast<float>(config.reach * config.reach);
  for (const Eigen::Vector3f& point : points_base) {
    if (!(point.head<2>().squaredNorm() <= reach2)) continue;
    const Eigen::Vector3d p = point.cast<double>();
    const double height = p.z() + config.base_height;
    const double rise = config.slope * p.head<2>().norm();
    if (!(height >= config.min_height + rise && height <= config.max_height + rise)) continue;
    const Eigen::Vector2i cell = (p.head<2>() / config.spacing).array().floor().cast<int>() + half;
    const auto index = static_cast<std::size_t>(cell.y() * 2 * half + cell.x());
    if (taken[index]) continue;
    taken[index] = true;
    obstacles.emplace_back(p.head<2>());
  }
  return obstacles;
}

}  // namespace fleetmap::agent
