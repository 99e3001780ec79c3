#include "site/point_text.hpp"

#include <cstdio>

namespace fleetmap::planning {

std::string point_text(const Eigen::Vector2d& p) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "(%.1f, %.1f)", p.x(), p.y());
  return buffer;
}

}  // namespace fleetmap::planning
