#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace fleetmap::sim {

/// A free lane along which a robot can map, from end to end (ENU, m).
struct Aisle {
  Eigen::Vector2d from = Eigen::Vector2d::Zero();
  Eigen::Vector2d to = Eigen::Vector2d::Zero();
};

/// A closed polygon (ENU, m), its last corner joined to its first.
using Footprint = std::vector<Eigen::Vector2d>;

/// A site as its builder drew it: rows of tables and buildings, all in their places. It lacks posts, trees
/// and parked things, and shows tables that are missing.
struct SiteDrawing {
  std::vector<Aisle> lanes;            ///< to map along, sorted across the site
  std::vector<Footprint> keep_out;     ///< rows of tables, buildings
  Footprint boundary;                  ///< the fence, or the edge of the ground
  std::vector<Eigen::Vector2d> marks;  ///< other marked places, such as the robots' starts
};

/// The drawing as it lies on the ground if it is off by `error` metres: all of it is shifted by `error` into
/// one direction and turned about its middle by what moves its farthest corner by 0.3 `error`; each lane and
/// each footprint is besides shifted by up to 0.2 `error` along each axis. The direction, the sense of the
/// turn and the shifts follow from the seed.
SiteDrawing with_position_error(const SiteDrawing& drawing, double error, std::uint64_t seed);

}  // namespace fleetmap::sim
