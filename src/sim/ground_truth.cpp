#include "fleetmap/sim/ground_truth.hpp"

namespace fleetmap::sim {

cloud::PointCloud ground_truth(const World& world, double points_per_m2, std::uint64_t seed,
                               std::size_t max_points) {
  constexpr double kBelow = 0.1;  // m: more than the grid's heights miss the mesh's by
  cloud::PointCloud cloud = sample_surface(world.mesh(), points_per_m2, seed, max_points);
  std::erase_if(cloud.points, [&world](const Eigen::Vector3f& p) {
    const Eigen::Vector3d point = p.cast<double>();
    return point.z() < world.ground_height(point.head<2>()) - kBelow;
  });
  return cloud;
}

}  // namespace fleetmap::sim
