#include "row_progress.hpp"

#include <algorithm>
#include <cmath>

namespace fleetmap::apps {

std::optional<double> row_progress(const planning::Row& row, const Eigen::Vector2d& at, double heading) {
  double length = 0.0, along = 0.0, nearest = kOffRow;
  Eigen::Vector2d direction = Eigen::Vector2d::Zero();
  for (std::size_t k = 1; k < row.waypoints.size(); ++k) {
    const Eigen::Vector2d piece = row.waypoints[k] - row.waypoints[k - 1];
    const double s = std::clamp((at - row.waypoints[k - 1]).dot(piece) / piece.squaredNorm(), 0.0, 1.0);
    const double distance = (row.waypoints[k - 1] + s * piece - at).norm();
    if (distance < nearest) {
      nearest = distance;
      along = length + s * piece.norm();
      direction = piece;
    }
    length += piece.norm();
  }
  if (direction.isZero()) return std::nullopt;
  const bool reversed = direction.dot(Eigen::Vector2d(std::cos(heading), std::sin(heading))) < 0.0;
  return reversed ? 1.0 - along / length : along / length;
}

}  // namespace fleetmap::apps
