#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

#include "fleetmap/cloud/codec.hpp"
#include "fleetmap/cloud/fit_config.hpp"
#include "fleetmap/cloud/ground.hpp"
#include "fleetmap/cloud/outliers.hpp"
#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/registration/spherize_config.hpp"

namespace fleetmap::registration {

/// M^s of the paper (Alg. 3): the map within r_o (SpherizeConfig::radius_m) of the node, in its frame, ready
/// for the long-range link.
struct SpherizedCloud {
  Bytes bytes;  ///< to be sent: at most fit.max_bytes
  cloud::PointCloud
      decoded;  ///< as the receiver sees it: register with this, so that both sides hold the same points
  float voxel_m = 0.0f;       ///< m, of the final thinning
  double resolution_m = 0.0;  ///< m, of the coding
  std::size_t points_in = 0;
  std::size_t refused = 0;   ///< non-finite
  std::size_t in_ball = 0;   ///< within radius_m
  std::size_t thinned = 0;   ///< after voxel_m
  std::size_t ground = 0;    ///< removed as ground
  std::size_t outliers = 0;  ///< removed as outliers
  std::size_t encoded = 0;   ///< points in `bytes`
};

/// Part of a map, in a frame of its own.
struct PlacedCloud {
  const cloud::PointCloud* points = nullptr;
  Pose T_node_cloud = Pose::Identity();
};

/// The parts together are the map: of points that several of them hold in one voxel the mean is taken.
/// `up` and errors as below.
Result<SpherizedCloud> spherize(std::span<const PlacedCloud> parts, const Eigen::Vector3f& up,
                                const SpherizeConfig& config);

/// `map_in_node_frame` is in the frame of the node (O at the origin); `up` points against gravity in that
/// frame. Fails on a bad config and where nothing fits the byte budget; a cloud of which nothing remains is
/// encoded as an empty one.
Result<SpherizedCloud> spherize(const cloud::PointCloud& map_in_node_frame, const Eigen::Vector3f& up,
                                const SpherizeConfig& config);

}  // namespace fleetmap::registration
