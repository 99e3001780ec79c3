#include "fleetmap/registration/prepared_cloud.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "comparison.hpp"
#include "fleetmap/cloud/voxel_grid.hpp"
#include "prepared_data.hpp"

namespace fleetmap::registration {
namespace {

constexpr float kMinHeightAboveFloor = 0.35f;  // m above the floor

std::vector<Eigen::Vector3f> levelled(const cloud::PointCloud& cloud, const Eigen::Matrix3d& R_level_cloud,
                                      const RegistrationConfig& config) {
  const Eigen::Matrix3f R = R_level_cloud.cast<float>();
  const float max_squared = config.max_range_m * config.max_range_m;
  cloud::PointCloud near;
  near.points.reserve(cloud.size());
  for (const auto& p : cloud.points) {
    if (p.squaredNorm() <= max_squared) near.points.push_back(R * p);
  }
  return voxel_downsample(near, config.voxel_m).points;
}

MovingPoints moving(const std::vector<Eigen::Vector3f>& points, const SurfelMap& surfels, const Floor& floor,
                    const RegistrationConfig& config) {
  MovingPoints all;
  all.points = points;
  const int side = 2 * static_cast<int>(std::ceil(config.max_range_m / config.patch_m)) + 1;
  all.patch_count = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
  all.patch_m = config.patch_m;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint16_t at = surfels.of_points()[i];
    Facing facing;
    if (at != SurfelMap::kNone && surfels.surfels()[at].planar)
      facing = {surfels.surfels()[at].axes[0], surfels.surfels()[at].side, true};
    all.facing.push_back(facing);
    const auto cell = [&](float v) {
      return std::clamp(static_cast<int>(std::floor(v / config.patch_m)) + side / 2, 0, side - 1);
    };
    all.above_floor.push_back(points[i].z() - floor.at(points[i].head<2>()) > kMinHeightAboveFloor ? 1 : 0);
    all.patches.push_back(static_cast<std::uint16_t>(cell(points[i].y()) * side + cell(points[i].x())));
  }
  return all;
}

MovingPoints picked(const MovingPoints& all, std::size_t count) {
  MovingPoints some;
  some.patch_count = all.patch_count;
  some.patch_m = all.patch_m;
  const std::size_t wanted = std::min(count, all.points.size());
  for (std::size_t k = 0; k < wanted; ++k) {
    const std::size_t i = k * all.points.size() / wanted;
    some.points.push_back(all.points[i]);
    some.facing.push_back(all.facing[i]);
    some.patches.push_back(all.patches[i]);
    some.above_floor.push_back(all.above_floor[i]);
  }
  return some;
}

}  // namespace

PreparedCloud::PreparedCloud(const cloud::PointCloud& cloud, const Eigen::Vector3d& up,
                             const RegistrationConfig& config) {
  auto data = std::make_shared<Data>();
  if (config.method == Method::paper) {
    data->features = FeatureCloud(cloud, config.paper);
    data_ = std::move(data);
    return;
  }
  data->R_level_cloud = levelling(up);
  const std::vector<Eigen::Vector3f> points = levelled(cloud, data->R_level_cloud, config);
  SurfelConfig surfels;
  surfels.voxel_m = config.surfel_m;
  data->surfels = SurfelMap(points, surfels);
  CorrelationGridConfig flat;
  flat.cell_m = config.cell_m;
  data->flat = correlation_grid(points, flat);
  data->all = moving(points, data->surfels, data->flat.floor, config);
  data->fine = picked(data->all, config.fine_points);
  data->middle = picked(data->all, (config.coarse_points + config.fine_points) / 3);
  data->coarse = picked(data->all, config.coarse_points);
  data->noise_m = noise_of(*data, config);
  data_ = std::move(data);
}

std::size_t PreparedCloud::size() const {
  return data_ ? std::max(data_->all.points.size(), data_->features.size()) : 0;
}

}  // namespace fleetmap::registration
