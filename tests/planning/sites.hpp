#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/planning/site/mission.hpp"

namespace fleetmap::planning::testing {

/// A solar farm as a site plan shows it.
struct SiteSpec {
  std::string name = "farm";
  double width = 200.0;   ///< m along the rows
  double depth = 200.0;   ///< m across them
  double pitch = 8.0;     ///< m between rows of tables
  double table = 4.0;     ///< m, depth of a table
  double piece = 20.0;    ///< m, length of a table
  double missing = 0.05;  ///< share of tables that are not there
  /// Cut into the outline as a share of the width: 0 a rectangle, 1 down to nothing at one end.
  double taper = 0.0;
  double ragged = 0.0;  ///< share of the width by which lanes end at random
  double turned = 0.0;  ///< rad, of the rows from east
  int every = 1;
  double max_row_length = 0.0;
  std::uint64_t seed = 1;
};

double uniform(std::mt19937_64& random);

Mission site(const SiteSpec& spec);

AgentId name(int k);

/// Robots side by side at the south-west corner.
std::vector<RobotAbility> fleet(int count, bool mixed_speeds = false);

/// A row of two waypoints, one of three and one of two.
Mission three_rows();

KeepOut box(double x0, double y0, double x1, double y1);

LocalFrame site_frame();

/// Rows by their index in the mission.
using Rows = std::vector<std::size_t>;

inline constexpr double kClearance = 0.7;  ///< m, of a robot from what it keeps out of

}  // namespace fleetmap::planning::testing
