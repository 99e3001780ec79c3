#pragma once

#include <cstdint>
#include <vector>

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
/// metres that a point lies in) too, where no covariance is asked for.
struct MovingPoints {
  std::vector<Eigen::Vector3f> points;
  std::vector<Facing> facing;
  std::vector<std::uint16_t> patches;
  std::vector<std::uint8_t> standing;  ///< 1 for what stands out of the floor
  std::size_t patch_count = 0;
};

/// Point-to-surfel ICP from `T_initial`: Gauss-Newton on SE(3), T <- T exp(xi), Geman-McClure weights.
IcpResult align(const SurfelMap& target, const MovingPoints& source, const Pose& T_initial,
                const IcpConfig& config, bool with_covariance);

}  // namespace fleetmap::registration
