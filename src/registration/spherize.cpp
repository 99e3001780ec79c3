#include "fleetmap/registration/spherize.hpp"

#include <algorithm>
#include <cmath>

#include "fleetmap/cloud/encode_within.hpp"
#include "fleetmap/cloud/voxel_grid.hpp"

namespace fleetmap::registration {

using cloud::PointCloud;

namespace {

PointCloud ball_of(const PointCloud& map, float radius_m, SpherizedCloud& counts) {
  std::vector<std::size_t> inside;
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (!map.points[i].allFinite()) {
      ++counts.refused;
    } else if (map.points[i].squaredNorm() <= radius_m * radius_m) {
      inside.push_back(i);
    }
  }
  counts.points_in += map.size();
  counts.in_ball += inside.size();
  return select(map, inside);
}

PointCloud thinned_ball(std::span<const PlacedCloud> parts, const SpherizeConfig& config,
                        SpherizedCloud& counts) {
  cloud::VoxelMerger merger(config.voxel_m, cloud::VoxelPoint::centroid);
  for (const PlacedCloud& part : parts) {
    merger.add(ball_of(cloud::transformed(*part.points, part.T_node_cloud), config.radius_m, counts));
  }
  counts.thinned = merger.voxels();
  return merger.cloud();
}

}  // namespace

Result<SpherizedCloud> spherize(const PointCloud& map_in_node_frame, const Eigen::Vector3f& up,
                                const SpherizeConfig& config) {
  const PlacedCloud whole{&map_in_node_frame, Pose::Identity()};
  return spherize(std::span(&whole, 1), up, config);
}

Result<SpherizedCloud> spherize(std::span<const PlacedCloud> parts, const Eigen::Vector3f& up,
                                const SpherizeConfig& config) {
  cloud::GroundConfig ground = config.ground;
  ground.up = up;
  if (auto valid = config.validate(); !valid) return failure(valid.error().message);
  if (auto valid = ground.validate(); !valid) return failure("spherize: " + valid.error().message);

  SpherizedCloud spherized;
  PointCloud points = thinned_ball(parts, config, spherized);
  PointCloud sparse_ground;
  if (config.remove_ground) {
    const cloud::GroundSplit split = split_ground(points, ground);
    if (config.ground_voxel_m > 0.0f) {
      sparse_ground = voxel_downsample(select(points, split.ground), config.ground_voxel_m);
    }
    points = select(points, split.kept);
    spherized.ground = split.ground.size();
  }
  const cloud::OutlierSplit split = split_outliers(points, config.outliers);
  points = select(points, split.kept);
  spherized.outliers = split.removed.size();
  append(points, sparse_ground);

  cloud::FitConfig fit = config.fit;
  fit.min_voxel_m = std::max(fit.min_voxel_m, config.voxel_m);
  fit.max_voxel_m = std::max(fit.max_voxel_m, fit.min_voxel_m);
  auto fitted = encode_within(points, fit);
  if (!fitted) return failure("spherize: " + fitted.error().message);
  spherized.bytes = std::move(fitted->bytes);
  spherized.decoded = std::move(fitted->decoded);
  spherized.voxel_m = fitted->voxel_m;
  spherized.resolution_m = fitted->resolution_m;
  spherized.encoded = spherized.decoded.size();
  return spherized;
}

}  // namespace fleetmap::registration
