#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <utility>
#include <vector>

#include "fleetmap/planning/site/mission.hpp"
#include "site/site_grid.hpp"

namespace fleetmap::planning {

/// Points at which shortest paths bend, and which of them see each other.
struct VisibilityGraph {
  using Edge = std::pair<std::uint32_t, double>;  ///< vertex, m

  std::vector<Eigen::Vector2d> vertices;
  std::vector<std::vector<Edge>> edges;
  double reach = 0.0;  ///< m, the longest edge that was looked for; infinite on all but huge sites

  static VisibilityGraph of(const Mission& mission, const SiteGrid& grid, double clearance);
};

}  // namespace fleetmap::planning
