#include "planning/sites.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "fleetmap/planning/site/row_selection.hpp"

namespace fleetmap::planning::testing {

double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1.0p-53; }

Mission site(const SiteSpec& spec) {
  std::mt19937_64 random(spec.seed);
  const Eigen::Rotation2Dd turned(spec.turned);
  std::vector<KeepOut> tables;
  Mission mission;
  const int rows = static_cast<int>(spec.depth / spec.pitch);
  double left = 0.0;
  double right = spec.width;
  for (int k = 0; k < rows; ++k) {
    const double y = k * spec.pitch;
    const double cut = spec.taper * spec.width * k / rows;
    left = std::round(0.3 * cut + spec.ragged * spec.width * uniform(random));
    right = std::round(spec.width - 0.7 * cut - spec.ragged * spec.width * uniform(random));
    if (right - left < spec.piece) right = left + spec.piece;
    const int pieces = std::max(1, static_cast<int>((right - left) / spec.piece));
    const double piece = (right - left) / pieces;
    // Tables side by side are one obstacle; a missing one is a gate.
    for (int first = 0; first < pieces;) {
      int end = first;
      while (end < pieces && uniform(random) >= spec.missing) ++end;
      if (end > first) {
        const Eigen::Vector2d low(left + first * piece, y - 0.5 * spec.table);
        const Eigen::Vector2d high(left + end * piece, y + 0.5 * spec.table);
        KeepOut polygon;
        for (const Eigen::Vector2d& p :
             {low, Eigen::Vector2d(high.x(), low.y()), high, Eigen::Vector2d(low.x(), high.y())}) {
          polygon.push_back(turned * p);
        }
        tables.push_back(polygon);
      }
      first = end + 1;
    }
    const double lane = y + 0.5 * spec.pitch;
    mission.rows.push_back({static_cast<RowId>(k),
                            {turned * Eigen::Vector2d(left, lane), turned * Eigen::Vector2d(right, lane)}});
  }
  mission.keep_out = std::move(tables);
  return with_selected_rows(std::move(mission), {spec.every, spec.max_row_length});
}

AgentId name(int k) { return *AgentId::parse(std::string("r").append(std::to_string(k + 1))); }

std::vector<RobotAbility> fleet(int count, bool mixed_speeds) {
  std::vector<RobotAbility> robots;
  for (int k = 0; k < count; ++k) {
    RobotAbility robot;
    robot.id = name(k);
    robot.start = {{-8.0, 3.0 * k - 8.0}, 0.0};
    if (mixed_speeds) robot.speed = 1.0 + 0.5 * (k % 3);
    robots.push_back(robot);
  }
  return robots;
}

Mission three_rows() {
  Mission mission;
  mission.rows = {{4, {{0, 0}, {100, 0}}}, {7, {{0, 8}, {30, 8}, {30, 48}}}, {9, {{0, 16}, {100, 16}}}};
  return mission;
}

KeepOut box(double x0, double y0, double x1, double y1) { return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}; }

LocalFrame site_frame() { return LocalFrame(geo_point_from_degrees(48.1, 11.6, 520.0)); }

}  // namespace fleetmap::planning::testing
