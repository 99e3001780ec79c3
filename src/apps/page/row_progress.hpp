#pragma once

#include <Eigen/Core>
#include <optional>

#include "fleetmap/planning/site/mission.hpp"

namespace fleetmap::apps {

/// Share of a row, [0, 1], that a robot at `at` (ENU, m) has driven of it. Rows are driven either way, so the
/// heading (rad, counter-clockwise from east) decides which end it came from. Empty while the robot is
/// farther from the row than kOffRow, as on its way there.
std::optional<double> row_progress(const planning::Row& row, const Eigen::Vector2d& at, double heading);
inline constexpr double kOffRow = 5.0;  ///< m

}  // namespace fleetmap::apps
