#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace fleetmap::registration {

struct NeighborPair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  float distance = 0.0f;  ///< m
};

/// Every unordered pair of points closer than `radius` (m), once. Points must be finite.
std::vector<NeighborPair> neighbor_pairs(const std::vector<Eigen::Vector3f>& points, float radius);

}  // namespace fleetmap::registration
