#pragma once

#include <cstdint>
#include <vector>

#include "bending.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/registration/icp.hpp"
#include "surfels.hpp"

namespace fleetmap::registration {

/// Which way the surface at a point faces.
struct Facing {
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();
  float side = 0.0f;    ///< as in Surfel
  bool planar = false;  ///< there is a normal
};

/// Points that move, and what is known of them. `facing` may be empty; `patches` (an index of the square
/// that a point lies in) too, where no covariance is asked for.
struct MovingPoints {
  std::vector<Eigen::Vector3f> points;
  std::vector<Facing> facing;
  std::vector<std::uint16_t> patches;
  std::vector<std::uint8_t> standing;  ///< 1 for what stands out of the floor
  std::size_t patch_count = 0;         ///< a square of squares around the origin, row by row
  float patch_m = 4.0f;                ///< m, edge of one
};

/// How the drift of the odometry bends both clouds.
struct Bendings {
  Bending target, source;
};

/// Point-to-surfel ICP from `T_initial`: Gauss-Newton on SE(3), T <- T exp(xi), Geman-McClure weights. With a
/// covariance if `bendings` are given.
IcpResult align(const SurfelMap& target, const MovingPoints& source, const Pose& T_initial,
                const IcpConfig& config, const Bendings* bendings = nullptr);

}  // namespace fleetmap::registration
