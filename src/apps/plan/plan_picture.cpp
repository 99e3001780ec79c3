#include "plan_picture.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "fleetmap/eval/picture.hpp"

namespace fleetmap::apps {
namespace {

constexpr eval::Rgb kGround{120, 124, 130};  // of keep-outs and boundary
constexpr eval::Rgb kMeeting{240, 240, 240};
constexpr double kPixels = 1500.0;  // across the picture

/// Lines as points so close to each other that they look drawn; what is added later lies above.
class Ink {
 public:
  explicit Ink(double spacing) : spacing_(spacing) {}

  void line(const planning::Polyline& points, eval::Rgb colour, int width) {
    level_ += 0.01f;
    for (std::size_t k = 1; k < points.size(); ++k) {
      const Eigen::Vector2d step = points[k] - points[k - 1];
      const Eigen::Vector2d side = Eigen::Vector2d(-step.y(), step.x()).normalized() * spacing_;
      const int count = std::max(1, static_cast<int>(std::ceil(step.norm() / spacing_)));
      for (int j = 0; j <= count; ++j) {
        for (int w = -width; w <= width; ++w)
          add(points[k - 1] + step * (static_cast<double>(j) / count) + w * side, colour);
      }
    }
  }
  void ring(planning::Polyline corners, eval::Rgb colour) {
    if (corners.empty()) return;
    corners.push_back(corners.front());
    line(corners, colour, 0);
  }
  void cross(const Eigen::Vector2d& at, eval::Rgb colour) {
    const double arm = 8.0 * spacing_;
    line({at - Eigen::Vector2d(arm, arm), at + Eigen::Vector2d(arm, arm)}, colour, 1);
    line({at - Eigen::Vector2d(arm, -arm), at + Eigen::Vector2d(arm, -arm)}, colour, 1);
  }
  Result<eval::Image> picture(eval::View view) const {
    view.point_size = spacing_;
    view.shading = 0.0;
    return eval::render(cloud_, colours_, view);
  }

 private:
  void add(const Eigen::Vector2d& p, eval::Rgb colour) {
    cloud_.points.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()), level_);
    colours_.push_back(colour);
  }
  double spacing_;
  float level_ = 0.0f;
  cloud::PointCloud cloud_;
  std::vector<eval::Rgb> colours_;
};

/// m, the longer side of what is drawn.
double extent_of(const planning::FleetPlan& plan) {
  Eigen::Vector2d low = plan.mission.rows.front().waypoints.front(), high = low;
  const auto include = [&](const std::vector<Eigen::Vector2d>& points) {
    for (const Eigen::Vector2d& p : points) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  };
  for (const planning::Row& row : plan.mission.rows) include(row.waypoints);
  for (const planning::KeepOut& polygon : plan.mission.keep_out) include(polygon);
  if (plan.mission.boundary) include(*plan.mission.boundary);
  return std::max(1.0, (high - low).maxCoeff());
}

}  // namespace

Result<eval::Image> picture_of(const planning::FleetPlan& plan) {
  Ink ink(extent_of(plan) / kPixels);
  for (const planning::KeepOut& polygon : plan.mission.keep_out) ink.ring(polygon, kGround);
  if (plan.mission.boundary) ink.ring(*plan.mission.boundary, kGround);
  eval::View view;
  view.title = "Division of the rows";
  for (std::size_t k = 0; k < plan.fleet.size(); ++k) {
    const eval::Rgb colour = eval::robot_colour(k);
    for (const planning::RowVisit& visit : plan.division.routes[k].visits) {
      const auto row = std::ranges::find(plan.mission.rows, visit.row, &planning::Row::id);
      ink.line(row->waypoints, colour, 2);
    }
    ink.line(planning::route_of(plan, k), colour, 0);
    view.legend.push_back({plan.fleet[k].id.str(), colour});
  }
  if (plan.meeting) {
    ink.cross(plan.meeting->place, kMeeting);
    view.legend.push_back({"meeting", kMeeting});
  }
  return ink.picture(view);
}

}  // namespace fleetmap::apps
